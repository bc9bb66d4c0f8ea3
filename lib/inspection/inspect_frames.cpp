// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <map>

#include "artefact/json_file.h"
#include "inspection/inspection.h"

// Chosen frames: rows are the images of the dataset.

namespace soslam {

using nlohmann::json;

Inspection InspectFrames(const json& document) {
  std::map<std::string, int> reasons;
  for (const json& frame : document.at("left_out")) ++reasons[frame.at("reason")];
  const json& hint = document.at("focal_hint");
  Inspection inspection;
  inspection.facts = {
      {"source", document.at("name")},
      {"images", fmt::format("{}, {} x {} px", document.at("frames").size(),
                             document.at("width").get<int>(), document.at("height").get<int>())},
      {"left out", CountsInWords(reasons)},
      {"focal length",
       hint.is_null()
           ? "not known"
           : FillIn("{focal_px:.0f} px, a guess from the EXIF data of {images} photos", hint)}};
  inspection.table = TableOf({{"image"},
                              {"source"},
                              {"frame", "", 2, "frame_number"},
                              {"time", "s", 3, "time_s"},
                              {"sharpness", "", 1}},
                             document.at("frames"));
  return inspection;
}

}  // namespace soslam
