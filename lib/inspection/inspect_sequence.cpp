// SPDX-License-Identifier: BSD-3-Clause
// Sequences: rows are objects.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "artefact/sequence_file.h"
#include "inspection/kinds.h"

namespace soslam {
namespace {

std::string CameraInWords(const Sequence& sequence) {
  const Camera& camera = sequence.camera;
  const auto others =
      std::ranges::count_if(sequence.frames, [](const Frame& frame) { return bool(frame.camera); });
  std::string text = fmt::format("{} x {} px, f {:g} x {:g} px", camera.width, camera.height,
                                 camera.fx, camera.fy);
  if (sequence.image_distortion) text += ", images with distortion";
  if (others > 0) text += fmt::format("; {} frames have cameras of their own", others);
  return text;
}

std::string FramesInWords(const Sequence& sequence) {
  if (sequence.frames.empty()) return "none";
  std::set<int> segments;
  for (const Frame& frame : sequence.frames) segments.insert(frame.segment);
  const auto count = [&](const auto& holds) {
    return std::ranges::count_if(sequence.frames, holds);
  };
  return fmt::format(
      "{}, ids {} to {}, segments: {}; {} with an image, {} with a true pose; {} held out",
      sequence.frames.size(), sequence.frames.front().id, sequence.frames.back().id,
      segments.size(), count([](const Frame& frame) { return !frame.image.empty(); }),
      count([](const Frame& frame) { return bool(frame.true_world_from_camera); }),
      sequence.held_out.size());
}

std::string ObjectsInWords(const Sequence& sequence) {
  const auto count = [&](const auto& holds) {
    return std::ranges::count_if(sequence.objects, holds);
  };
  return fmt::format(
      "{}, {} with ground truth, {} static; support planes: {}", sequence.objects.size(),
      count([](const Object& object) { return bool(object.ground_truth); }),
      count([](const Object& object) { return object.is_static; }), sequence.planes.size());
}

std::string DetectionsInWords(const Sequence& sequence) {
  int rejected = 0;
  for (const auto& [reason, count] : sequence.rejected_detections) rejected += count;
  std::string text = fmt::format("{} used, {} rejected", sequence.detections.size(), rejected);
  if (rejected > 0) text += ": " + CountsInWords(sequence.rejected_detections);
  return text;
}

std::vector<Value> ObjectRow(const Sequence& sequence, const Object& object,
                             const std::vector<int>& detections) {
  const bool has_plane = object.plane_index != kNoPlane;
  std::vector<Value> row = {
      object.id, object.label,
      has_plane ? Value(sequence.planes[static_cast<size_t>(object.plane_index)].id) : Value(),
      detections.size()};
  if (detections.empty()) {
    row.insert(row.end(), 6, Value());
  } else {
    const auto of = [&](int i) -> const Detection& {
      return sequence.detections[static_cast<size_t>(i)];
    };
    double score = 0.0, width = 0.0, height = 0.0;
    int cut = 0;
    for (const int i : detections) {
      score += of(i).score;
      width += of(i).box.Width();
      height += of(i).box.Height();
      cut += std::ranges::find(of(i).is_bound, true) != of(i).is_bound.end() ? 1 : 0;
    }
    const auto count = static_cast<double>(detections.size());
    row.insert(row.end(), {sequence.FrameOf(of(detections.front())).id,
                           sequence.FrameOf(of(detections.back())).id, score / count, width / count,
                           height / count, cut});
  }
  row.emplace_back(object.ground_truth.has_value());
  row.emplace_back(object.is_static);
  return row;
}

}  // namespace

Inspection InspectSequence(const std::filesystem::path& file) {
  const Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
  Inspection inspection;
  inspection.facts = {{"dataset", sequence.name},
                      {"camera", CameraInWords(sequence)},
                      {"frames", FramesInWords(sequence)},
                      {"objects", ObjectsInWords(sequence)},
                      {"detections", DetectionsInWords(sequence)}};
  inspection.table.columns = {{"object", ""},     {"label", ""},           {"plane", ""},
                              {"views", ""},      {"first_frame", ""},     {"last_frame", ""},
                              {"mean_score", ""}, {"mean_width", "px", 0}, {"mean_height", "px", 0},
                              {"cut_boxes", ""},  {"truth", ""},           {"static", ""}};
  const auto by_object = DetectionsByObject(sequence);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    inspection.table.rows.push_back(ObjectRow(sequence, sequence.objects[i], by_object[i]));
  }
  return inspection;
}

}  // namespace soslam
