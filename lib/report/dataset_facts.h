// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

// The numbers of a sequence.json.
struct DatasetCounts {
  int frames = 0;         // held-out ones included
  int objects = 0;        // true ones that a map should contain
  int round_objects = 0;  // those of them whose yaw has no meaning
};

// What tables say of a dataset beside its name.
struct DatasetFacts {
  std::optional<DatasetCounts> counts = std::nullopt;  // none without a sequence.json
  std::string odometry = {};                           // origin of the pose estimates

  // The field "about" of the dataset's settings (schemas/about.schema.json).
  std::string boxes_of = {};  // "detector", "simulation", "labels"; empty: not said
  std::string boxes = {};
  std::string annotation = {};
  bool partly_annotated = false;
  std::string published = {};
  std::string differs = {};

  bool HasDetectorBoxes() const { return boxes_of == "detector"; }
};

// Reads the field "about" of a file of settings, if it is there and has one. Throws InputError.
void ReadAbout(const std::filesystem::path& settings, DatasetFacts* facts);

// Counts what is in a sequence.json. Throws InputError.
void CountSequence(const std::filesystem::path& sequence, DatasetFacts* facts);

// At most so many objects are few: their mean says little of a method.
inline constexpr int kFewObjects = 2;

// Letters for what limits the means of a row over so many objects of the dataset: "p, r"; kNoValue
// if there is nothing. MarksNote says what they mean.
std::string MarksOf(const DatasetFacts& facts, int objects);
std::string MarksNote();

// In what the dataset differs from the published one of its rows: "9 frames, 4 objects; boxes:
// YOLOX-nano; ...".
std::string DifferencesInWords(const DatasetFacts& facts);

}  // namespace soslam
