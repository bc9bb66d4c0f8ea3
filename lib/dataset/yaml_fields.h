// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace soslam {

// What a calibration or a list of names holds, by key: the scalars of a list in their order, those
// of lists in lists one list after the other; the keys of maps in maps are joined by points, as in
// "camera_matrix.data".
using NamedFields = std::map<std::string, std::vector<std::string>>;

// How deep and how many such files have them, and characters of all keys around a value.
inline constexpr size_t kMaxFieldDepth = 10;
inline constexpr size_t kMaxFieldValues = 100000;
inline constexpr size_t kMaxFieldPath = 200;

// The part of YAML that cameras, calibrations and names of classes are written in, OpenCV's
// included: maps, lists of scalars, both also in brackets and over several lines, quotes, comments;
// of several documents the first one. Tags are ignored, and blocks of text (| and >) left out.
// Throws InputError naming the line: for what else YAML has (lists of maps, anchors), for the same
// key twice, and for more, or deeper nested, than such files are.
NamedFields ReadYamlFields(const std::filesystem::path& path);
// The same of a text that is not a file of its own; `name` stands for it in error messages.
NamedFields YamlFields(const std::string& text, const std::string& name);

}  // namespace soslam
