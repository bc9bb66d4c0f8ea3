// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "inspection/evidence_pictures.h"

namespace soslam {

// Arguments of soslam-inspect.
struct InspectRequest {
  std::filesystem::path file;
  bool headline = false;                       // one line instead, of a map.json
  std::optional<std::filesystem::path> csv;    // output path of the table; "-" is standard output
  std::optional<std::filesystem::path> image;  // output path of the picture, a .png
  std::optional<std::filesystem::path> sequence;  // the sequence that the artefact was made from
  std::optional<std::filesystem::path> dataset;   // folder with the images
  std::optional<int> frame_id;                    // frame of the picture
  std::optional<int> object_id;
  EdgeLayer layer = EdgeLayer::kAll;
};

// Writes the requested table and picture and returns the text for standard output: with `headline`
// one line on a map.json, "9 objects, scale +- 18 %, 2 objects uncertain", whose sequence.json is
// beside it unless another one is given; the table as CSV if requested there; nothing if files were
// requested; otherwise a description of the artefact and its table, with escape sequences if
// `is_coloured`. Throws InputError for a file that is no artefact, SettingsError for a picture that
// this artefact cannot give.
std::string RunInspect(const InspectRequest& request, bool is_coloured);

}  // namespace soslam
