// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/frames_file.h"

namespace soslam {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FocalHint, focal_px, images)

namespace {

using nlohmann::json;

json SourceToJson(const SourceFrame& frame) {
  return {{"source", frame.source},
          {"frame_number", frame.frame_number},
          {"time_s", frame.time_s},
          {"sharpness", frame.sharpness}};
}

}  // namespace

std::string FramesText(const std::filesystem::path& path, const FramesRecord& record,
                       const ArtefactInfo& info) {
  json body = {{"name", record.name},     {"width", record.width},
               {"height", record.height}, {"focal_hint", record.focal_hint},
               {"frames", json::array()}, {"left_out", json::array()}};
  for (const SourceFrame& frame : record.frames) {
    json entry = SourceToJson(frame);
    if (frame.rejection) {
      entry["reason"] = kFrameRejectionNames[static_cast<size_t>(*frame.rejection)];
      entry["detail"] = frame.detail;
    } else {
      entry["image"] = frame.image;
    }
    body[frame.rejection ? "left_out" : "frames"].push_back(std::move(entry));
  }
  return ArtefactText(path, "frames", info, std::move(body));
}

}  // namespace soslam
