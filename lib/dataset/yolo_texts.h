// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/text_file.h"

namespace soslam {

// The boxes of one image, one per line.
struct YoloText {
  std::string image;  // its name without extension
  std::vector<TextLine> lines;
};

// Content of a folder or an archive of YOLO's labels.
struct YoloTexts {
  std::vector<YoloText> images;                   // sorted by name
  std::optional<std::vector<std::string>> names;  // of the classes, in an archive that has them
  std::string names_place;                        // place of the names, for messages
};

// Reads the *.txt of a folder, or of an archive (ReadTextArchive) at any depth. Skipped are hidden
// files (of macOS), __MACOSX, README*, and the lists classes.txt, train.txt, val.txt, valid.txt and
// test.txt of CVAT and others unless they begin with a number, as boxes do. Throws InputError when
// there is nothing to read, and for two files of one name.
YoloTexts ReadYoloTexts(const std::filesystem::path& path);

}  // namespace soslam
