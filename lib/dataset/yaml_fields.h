// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace soslam {

// Fields of a calibration or a list of names, by key: the scalars of a list in order, with nested
// lists concatenated; keys of nested maps are joined by points, as in "camera_matrix.data".
using NamedFields = std::map<std::string, std::vector<std::string>>;

// Limits on nesting depth, number of values, and characters of all keys around a value.
inline constexpr size_t kMaxFieldDepth = 10;
inline constexpr size_t kMaxFieldValues = 100000;
inline constexpr size_t kMaxFieldPath = 200;

// Parses the subset of YAML used for cameras, calibrations and class names, including OpenCV's:
// maps, lists of scalars, both also in brackets and over several lines, quotes, comments; only the
// first of several documents. Tags are ignored, and blocks of text (| and >) skipped. Throws
// InputError naming the line for other YAML (lists of maps, anchors), for the same key twice, and
// beyond the limits above.
NamedFields ReadYamlFields(const std::filesystem::path& path);
// ReadYamlFields for a text that is not a file of its own; `name` stands for it in error messages.
NamedFields YamlFields(const std::string& text, const std::string& name);

// Reads the words in each element of an XML file written by OpenCV, keyed by the names of the
// enclosing elements without the outermost one: "camera_matrix.data". Attributes and comments are
// skipped; entities and CDATA are not supported. Throws InputError for an element that is not
// closed or occurs twice, and for a file larger or nested deeper than a calibration.
NamedFields ReadXmlFields(const std::filesystem::path& path);

}  // namespace soslam
