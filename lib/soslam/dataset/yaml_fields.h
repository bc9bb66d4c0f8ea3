// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

namespace soslam {

// Fields of a calibration or a list of names, by key: the scalars of a list in order, with nested
// lists concatenated; keys of nested maps are joined by points, as in "camera_matrix.data".
using NamedFields = std::map<std::string, std::vector<std::string>>;

// Parses YAML as it is used for cameras, calibrations and class names, including OpenCV's; only the
// first of several documents. Tags are ignored. Throws InputError naming the line for the same key
// twice, and for a text larger or nested deeper than a calibration. `name` stands for the text in
// error messages.
NamedFields YamlFields(const std::string& text, const std::string& name);

// Parses the words in each element of XML written by OpenCV, keyed by the names of the enclosing
// elements without the outermost one: "camera_matrix.data". Attributes and comments are skipped;
// entities and CDATA are not supported. Throws InputError for an element that is not closed or
// occurs twice, and for a text larger or nested deeper than a calibration.
NamedFields XmlFields(const std::string& text, const std::string& name);

}  // namespace soslam
