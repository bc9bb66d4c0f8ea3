// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/yaml_fields.h"

namespace soslam {

// Reads the words in each element of an XML file written by OpenCV, keyed by the names of the
// enclosing elements without the outermost one: "camera_matrix.data". Attributes and comments are
// skipped; entities and CDATA are not supported. Throws InputError for an element that is not
// closed or occurs twice, and for a file larger or nested deeper than a calibration.
NamedFields ReadXmlFields(const std::filesystem::path& path);

}  // namespace soslam
