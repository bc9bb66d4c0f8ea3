// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "model/sequence.h"
#include "report/page_images.h"

namespace soslam {

// The first section of a dataset's page, as HTML without scripts: the map of the variant in this
// folder from above, its objects with pictures, what was seen but not placed, and photos without a
// pose; empty where that has no room in `max_bytes`. Throws InputError for files that are not
// valid.
std::string MapSection(const std::string& title, const std::filesystem::path& folder,
                       const Sequence& sequence, const ImageSource& images, size_t max_bytes,
                       int threads);

}  // namespace soslam
