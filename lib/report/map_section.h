// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "model/sequence.h"
#include "report/page_images.h"

namespace soslam {

// The first section of a dataset's page, as HTML without scripts: the map of the variant in this
// folder from above, its objects with pictures, and what was seen but not placed. Throws InputError
// for files that are not valid.
std::string MapSection(const std::string& title, const std::filesystem::path& folder,
                       const Sequence& sequence, const ImageSource& images, int threads);

}  // namespace soslam
