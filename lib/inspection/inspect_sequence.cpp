// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "artefact/files.h"
#include "artefact/json_file.h"
#include "base/text.h"
#include "inspection/inspection.h"
#include "model/label_groups.h"
#include "model/segments.h"

// Sequences: rows are objects.

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
  const auto count = [&](const auto& holds) {
    return std::ranges::count_if(sequence.frames, holds);
  };
  return fmt::format(
      "{}, ids {} to {}, segments: {}; {} with an image, {} with a true pose; {} held out",
      sequence.frames.size(), sequence.frames.front().id, sequence.frames.back().id,
      SegmentsOf(sequence).size(), count([](const Frame& frame) { return !frame.image.empty(); }),
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
  std::vector<Value> row = {object.id, LabelInWords(object),
                            has_plane ? Value(sequence.planes[object.plane_index].id) : Value(),
                            detections.size()};
  if (detections.empty()) {
    row.insert(row.end(), 6, Value());
  } else {
    const auto of = [&](int i) -> const Detection& { return sequence.detections[i]; };
    double score = 0.0, width = 0.0, height = 0.0;
    int cut = 0;
    for (const int i : detections) {
      score += of(i).score;
      width += of(i).box.Width();
      height += of(i).box.Height();
      cut += std::ranges::find(of(i).is_one_sided, true) != of(i).is_one_sided.end() ? 1 : 0;
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
  inspection.table.columns = {{"object"},
                              {"label"},
                              {"plane"},
                              {"views"},
                              {"first_frame"},
                              {"last_frame"},
                              {"mean_score"},
                              {"mean_width", "px", 0},
                              {"mean_height", "px", 0},
                              {"cut_boxes"},
                              {"truth"},
                              {"static"}};
  const auto by_object = DetectionsByObject(sequence);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    inspection.table.rows.push_back(ObjectRow(sequence, sequence.objects[i], by_object[i]));
  }
  return inspection;
}

using nlohmann::json;

// Chosen frames: rows are the images of the dataset.
Inspection InspectFrames(const json& document) {
  const json& hint = document.at("focal_hint");
  Inspection inspection;
  inspection.facts = {
      {"source", document.at("name")},
      {"images", fmt::format("{}, {} x {} px", document.at("frames").size(),
                             document.at("width").get<int>(), document.at("height").get<int>())},
      {"left out", CountsInWords(CountsBy("reason", document.at("left_out")))},
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

// Associations: rows are the objects that were found.

namespace {

constexpr const char* kAgreement =
    "{objects} objects found, {given_objects} given, {matched} of them the same; precision "
    "{precision:.3f}, recall {recall:.3f}, F1 {f1:.3f}";

}  // namespace

Inspection InspectAssociations(const json& document) {
  const auto counts = [&](const char* rows, const char* field) {
    return fmt::format("{}: {}", document.at(rows).size(),
                       CountsInWords(CountsBy(field, document.at(rows))));
  };
  Inspection inspection;
  inspection.facts = {{"agreement", FillIn(kAgreement, document.at("agreement"))},
                      {"detections", counts("detections", "decision")},
                      {"tracks", counts("tracks", "fate")}};
  json objects = document.at("objects");
  for (json& object : objects) {
    json& votes = object["label_votes"];
    votes = CountsInWords(votes.get<std::map<std::string, int>>());
  }
  inspection.table =
      TableOf({{"object"}, {"label"}, {"track"}, {"detections"}, {"given_object"}, {"label_votes"}},
              objects);
  return inspection;
}

// Estimated planes: rows are planes.

namespace {

// "1 sofa, 3 armchair (lowest_cost)"; without a reason if the plane follows from an object's own
// views.
std::string ObjectsOn(const json& plane, const json& objects) {
  std::vector<std::string> words;
  for (const json& object : objects) {
    if (object.at("plane") != plane.at("plane")) continue;
    const bool is_own = object.at("reason") == "own_height";
    words.push_back(FillIn(is_own ? "{object} {label}" : "{object} {label} ({reason})", object));
  }
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

Inspection InspectPlanes(const json& document) {
  const json& objects = document.at("objects");
  Inspection inspection;
  inspection.facts = {
      {"dataset", document.at("dataset")},
      {"found",
       fmt::format("planes: {}, objects: {}; {} after {} rounds", document.at("planes").size(),
                   objects.size(), document.at("settled").get<bool>() ? "settled" : "NOT settled",
                   document.at("rounds").get<int>())},
      {"decided by", CountsInWords(CountsBy("reason", objects))}};
  if (!document.at("cost").is_null()) {
    inspection.facts.push_back({"cost", FillIn("{cost:.6g}", document)});
  }
  json planes = document.at("planes");
  for (json& plane : planes) plane["objects"] = ObjectsOn(plane, objects);
  inspection.table = TableOf({{"plane"},
                              {"normal_x", "", 4, "plane_in_world/normal/0"},
                              {"normal_y", "", 4, "plane_in_world/normal/1"},
                              {"normal_z", "", 4, "plane_in_world/normal/2"},
                              {"offset", "m", 3, "plane_in_world/offset"},
                              {"sigma_tilt", "deg", 2, "tilt_sigma_deg"},
                              {"sigma_height", "m", 3, "height_sigma_m"},
                              {"tilt_error", "deg", 2, "error/angle_deg"},
                              {"height_error", "m", 3, "error/offset_m"},
                              {"objects"}},
                             planes);
  return inspection;
}

// Semantic tables: rows are labels.

namespace {

std::vector<Value> RowOf(const SemanticRow& row) {
  const ShapePrior& prior = row.prior;
  const bool has_height = prior.height_m.has_value();
  return {row.label,
          prior.ratio.x(),
          prior.ratio.y(),
          prior.log_sigma.x(),
          prior.log_sigma.y(),
          prior.log_correlation,
          has_height ? Value(prior.height_m->median) : Value(),
          has_height ? Value(prior.height_m->log_sigma) : Value(),
          prior.shape_exponents.horizontal,
          prior.shape_exponents.HasAxis() ? Value(prior.shape_exponents.vertical) : Value(),
          kMountNames[static_cast<size_t>(prior.mount)],
          kAttitudeNames[static_cast<size_t>(prior.attitude)],
          row.samples,
          row.aliases.empty() ? Value() : Value(fmt::format("{}", fmt::join(row.aliases, ", "))),
          row.source};
}

}  // namespace

Inspection InspectSemanticTable(const std::filesystem::path& file) {
  const SemanticRows rows = ReadSemanticRows(file);
  const auto learned =
      std::ranges::count_if(rows.rows, [](const SemanticRow& row) { return row.samples > 0; });
  Inspection inspection;
  inspection.facts = {
      {"what", rows.description},
      {"labels", fmt::format("{}, {} of them from samples; {} for others", rows.rows.size(),
                             learned, rows.default_row ? "a default" : "nothing")}};
  inspection.table.columns = {{"label"},
                              {"a_by_c"},
                              {"b_by_c"},
                              {"a_by_c_log_sigma"},
                              {"b_by_c_log_sigma"},
                              {"log_correlation"},
                              {"height", "m"},
                              {"height_log_sigma"},
                              {"p"},
                              {"p_vertical"},
                              {"mount"},
                              {"attitude"},
                              {"samples"},
                              {"aliases"},
                              {"source"}};
  if (rows.default_row) inspection.table.rows.push_back(RowOf(*rows.default_row));
  for (const SemanticRow& row : rows.rows) inspection.table.rows.push_back(RowOf(row));
  return inspection;
}

}  // namespace soslam
