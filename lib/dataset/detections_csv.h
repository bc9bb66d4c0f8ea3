// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// Reads detections.csv, a table whose first line names the columns, in any order: frame, object_id,
// label, score, x1, y1, x2, y2; others are ignored. Column names are case-insensitive, with blanks
// equal to underscores. Fields may be quoted (SplitCsvLine) and use the separator of the header:
// comma, semicolon or tab. Frames are rows of rgb.txt.
//
// The column object_id may be absent, and its fields may be empty. Throws InputError naming the
// line, and for a file without header.
std::vector<LabelledBox> ReadDetectionsCsv(const std::filesystem::path& path);

// CSV text of a table without object ids, pixels with two decimals, scores with four. The frames
// must be rows of rgb.txt, the labels without comma.
std::string LabelledBoxesText(const std::vector<LabelledBox>& boxes);

}  // namespace soslam
