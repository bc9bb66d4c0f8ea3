// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "soslam/model/finding.h"

namespace soslam {

// Class names of a detector, from class 0 on: one per line (classes.txt, obj.names), or the `names`
// of YOLO's data.yaml, a list or a map with all numbers from 0. In a text, blank lines and comments
// (first character #) are skipped. Throws InputError for a name with a comma, which the setting
// `labels` cannot contain, and for a file without names.
std::vector<std::string> ReadLabelFile(const std::filesystem::path& path);
// ReadLabelFile for a text that is not a file of its own; `name` stands for it in error messages,
// and its extension determines the format.
std::vector<std::string> ParseLabels(const std::string& text, const std::string& name);

// True if the list, labels separated by commas, has the label or is empty.
bool IsListed(const std::string& label, const std::string& list);

// A list of class names that was found.
struct ClassNames {
  std::filesystem::path place;                      // the file, also in an archive
  std::vector<std::string> names;                   // none where the text has none
  std::optional<std::string> error = std::nullopt;  // why the text cannot be read
};

// The class names in a text that `read` returns, as ParseLabels.
ClassNames FindLabels(const std::filesystem::path& place, const std::function<std::string()>& read);

// The list nearest to the labels. A list farther away that cannot be read is a finding; so are the
// names that labelImg comes with, which are left out if another list contradicts them. Throws
// InputError if another list contradicts the nearest one, or cannot be read and is nearer. None
// without names.
std::optional<ClassNames> NearestNames(std::vector<ClassNames> lists,
                                       std::vector<Finding>* findings);

// True if files of this name hold the class names in folders and archives of YOLO's labels.
bool IsLabelFile(const std::filesystem::path& name);

// Finds the files with class names among the labels in a folder, beside that folder (or beside a
// label file), and in parent folders up to that of the dataset, nearest first.
std::vector<std::filesystem::path> FindLabelFiles(const std::filesystem::path& labels,
                                                  const std::filesystem::path& dataset);

// Names of COCO's 80 object classes, in the order of detectors trained on COCO, from 0 (T.-Y. Lin
// et al., "Microsoft COCO: Common Objects in Context", ECCV 2014).
const std::vector<std::string>& CocoLabels();

// Index in CocoLabels of a category id of COCO's annotation files. These ids run from 1 to 90
// without ten numbers of dropped categories; none for these and others.
std::optional<int> CocoClassIndex(int category_id);

// Category id of an index in CocoLabels.
int CocoCategoryId(int class_index);

}  // namespace soslam
