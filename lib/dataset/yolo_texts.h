// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/text_file.h"

namespace soslam {

// The boxes of one image, a line each.
struct YoloText {
  std::string image;  // its name without extension
  std::vector<TextLine> lines;
};

// What a folder or an archive of YOLO's labels holds.
struct YoloTexts {
  std::vector<YoloText> images;                   // by name
  std::optional<std::vector<std::string>> names;  // of the classes, in an archive that has them
  std::string names_place;                        // of these
};

// The *.txt of a folder, or of an archive (ReadTextArchive) at any depth. Left out are names that
// begin with a point (of macOS), what __MACOSX holds, README*, and where they do not begin with a
// number, as boxes do, the lists classes.txt, train.txt, val.txt, valid.txt and test.txt of CVAT
// and others. Throws InputError when there is nothing to read, and for two files of one name.
YoloTexts ReadYoloTexts(const std::filesystem::path& path);

}  // namespace soslam
