// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/yaml_fields.h"

namespace soslam {

// The words in each element of an XML file as OpenCV writes it, by the names of the elements around
// them without the outermost one: "camera_matrix.data". Attributes and comments are left out;
// entities and CDATA are not known. Throws InputError for an element that is not closed or comes
// twice, and for more, or deeper nested, than a calibration is.
NamedFields ReadXmlFields(const std::filesystem::path& path);

}  // namespace soslam
