// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/artefact/options_json.h"
#include "soslam/association/agreement.h"
#include "soslam/association/association.h"
#include "soslam/association/edits.h"
#include "soslam/association/moved_things.h"
#include "soslam/association/options.h"
#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/result_checks.h"
#include "soslam/geometry/angles.h"
#include "soslam/ground/estimate_ground.h"
#include "soslam/ground/ground_checks.h"
#include "soslam/ground/options.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/mapping/back_end.h"
#include "soslam/mapping/initial_landmarks.h"
#include "soslam/mapping/options.h"
#include "soslam/model/label_groups.h"
#include "soslam/model/moving_things.h"
#include "soslam/model/reasons.h"
#include "soslam/planes/estimate_planes.h"
#include "soslam/planes/options.h"
#include "soslam/planes/planes_and_orientation.h"
#include "soslam/planes/planes_estimate.h"
#include "soslam/planes/scene_axis.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"

namespace soslam {
namespace {

// Summary of the tracks' fates: "12 object, 3 merged".
std::string DescribeTracks(const Association& association) {
  std::map<std::string, int> counts;
  for (const Track& track : association.tracks) {
    ++counts[NameOf(track.fate)];
  }
  return CountsInWords(ReasonsInWords(counts));
}

// Evidence of the matches of soslam-match about pairs of boxes; empty where they are not used.
PairEvidence ReadPairs(bool shared_points, const Sequence& sequence, const StageFiles& files) {
  if (!shared_points) return {};
  if (!files.contains("matches")) {
    throw SettingsError("shared_points = true needs --matches, the matches.h5 of soslam-match");
  }
  const ImageMatches matches = ReadMatches(files.at("matches"));
  if (matches.colours.size() != sequence.detections.size()) {
    throw InputError(fmt::format(
        "{}: found colours of {} boxes; expected {}, those of {}; likely cause: the file is of "
        "another sequence",
        files.at("matches").string(), matches.colours.size(), sequence.detections.size(),
        files.at("sequence").string()));
  }
  return {sequence, matches};
}

// Throws InputError for an edit that gives a label which the table does not have.
void CheckEditedLabels(const Edits& edits, const SemanticTable& table) {
  for (size_t i = 0; i < edits.edits.size(); ++i) {
    const std::string label = NormalisedLabel(edits.edits[i].label);
    if (label.empty() || table.priors.contains(label)) continue;
    std::vector<std::string> known;
    for (const auto& [name, prior] : table.priors) known.push_back(name);
    const auto meant = LikelyMeant(label, known);
    throw InputError(fmt::format(
        "{}: /edits/{}/label is \"{}\"; expected a label of the semantic table{}", edits.file, i,
        edits.edits[i].label, meant ? fmt::format(", as \"{}\"", *meant) : ""));
  }
}

}  // namespace

void RunAssociate(const AssociateOptions& settings, const StageFiles& files, int threads) {
  if (settings.association == AssociationSource::kGiven) {
    throw SettingsError(
        "setting 'association' is 'given', which leaves nothing to do; expected 'estimated'");
  }
  Sequence sequence = ReadSequence(files.at("sequence"), PlaneNeed::kNotNeeded);
  AssociateOptions options = settings;
  options.moving_labels = sequence.moving_labels;
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  if (!options.use_planes) sequence = WithoutPlanes(std::move(sequence));
  const PairEvidence pairs = ReadPairs(options.shared_points, sequence, files);
  const Edits edits = files.contains("edits") ? ReadEdits(files.at("edits")) : Edits();
  CheckEditedLabels(edits, table);
  const Association association = Associate(sequence, table, pairs, options, threads, edits);
  if (association.objects.empty()) {
    throw NothingUsableError(fmt::format("{}: no object in {} detections; tracks: {}",
                                         files.at("sequence").string(), sequence.detections.size(),
                                         DescribeTracks(association)));
  }
  const Agreement agreement = CompareWithGiven(sequence, association, options.min_observations);
  ArtefactInfo info = {.settings = OptionsToJson(options),
                       .inputs = {files.at("sequence"), files.at("table")},
                       .stage = "associate"};
  if (options.shared_points) info.inputs.push_back(files.at("matches"));
  if (files.contains("edits")) info.inputs.push_back(files.at("edits"));
  for (const auto& [segment, up] : association.up_of_segments) {
    info.findings = CheckUp(up.orientation, up.orientations, up.orientation_tilt_variance);
    if (!info.findings.empty()) break;  // the first segment whose up direction is ambiguous
  }
  if (!association.is_settled) {
    info.findings.push_back({"association_not_settled", Severity::kWarning,
                             "boxes still changed objects when the limit of rounds was reached",
                             "none that does", "boxes that fit several objects about as well",
                             "look at the boxes of the objects: soslam-inspect, or the page"});
  }
  Sequence associated = AssociatedSequence(sequence, association, agreement);
  if (!edits.edits.empty()) {
    associated.edits = AppliedEdits{{}, Sha256OfFile(edits.file)};
    for (const Edit& edit : edits.edits) ++associated.edits->kinds[NameOf(edit.kind)];
  }
  std::ranges::move(CheckEdits(sequence, association), std::back_inserter(info.findings));
  std::ranges::move(CheckMovedThings(sequence, association), std::back_inserter(info.findings));
  ReportFindings("associate", info.findings);
  WriteAssociations(files.at("associations"), MakeReport(sequence, association, agreement), info);
  WriteSequence(files.at("output"), associated, info);
  fmt::print("{} objects with {} of {} detections; tracks: {}\n", association.objects.size(),
             associated.detections.size(), sequence.detections.size(), DescribeTracks(association));
  if (associated.edits) fmt::print("{}\n", InWords(*associated.edits));
  if (const auto f1 = agreement.F1()) {
    fmt::print("{} of {} given objects found; F1 {:.3f}\n", agreement.matched,
               agreement.given_objects, *f1);
  }
}

namespace {

struct Result {
  PlanesEstimate estimate;
  Sequence sequence;
  std::vector<std::filesystem::path> inputs;  // in addition to the sequence
};

// Optimises poses, planes and bodies jointly, as odometry also drifts along the plane's normal; the
// poses of `level` are replaced. Objects that may lie have no ratio, and those that may lean are
// left out.
void RefineWithPoses(std::vector<std::optional<ShapePrior>> priors, const PlanesOptions& options,
                     int threads, PlanesEstimate* estimate, Sequence* level) {
  const Sequence sequence = WithPlanes(*level, *estimate);
  OptimiseOptions optimise;
  optimise.detection_model = DetectionModel::kTangency;
  optimise.upright = options.upright;  // whose axes of the scene are not known yet
  optimise.odometry_translation_sigma_m = options.odometry_translation_sigma_m;
  if (options.odometry_rotation_sigma_deg > 0.0) {
    optimise.odometry_rotation_sigma_deg = options.odometry_rotation_sigma_deg;
  }
  std::vector<bool> may_lean;
  for (auto& prior : priors) {
    may_lean.push_back(prior && prior->attitude == Attitude::kFree);
    if (prior && prior->attitude != Attitude::kStanding) prior.reset();
  }
  BackEndInput input{sequence, {}, priors};
  input.initial_landmarks = ChooseInitialUprightLandmarks(input, {}, optimise, threads);
  for (size_t i = 0; i < may_lean.size(); ++i) {
    if (may_lean[i]) input.initial_landmarks[i].reset();
  }
  const MapEstimate map = OptimiseMap(input, optimise, threads);
  for (size_t i = 0; i < map.planes_in_world.size(); ++i) {
    EstimatedPlane& plane = estimate->planes[i];
    plane.plane_in_world = map.planes_in_world[i];
    const Eigen::Vector3d& normal = plane.plane_in_world.normal;
    plane.point_in_world -= plane.plane_in_world.SignedDistance(plane.point_in_world) * normal;
    const Eigen::Vector3d x =
        (plane.x_axis_in_world - normal.dot(plane.x_axis_in_world) * normal).normalized();
    plane.x_axis_in_world = x;
    plane.covariance.reset();
    const auto covariance = map.plane_covariances.find(static_cast<int>(i));
    if (covariance == map.plane_covariances.end()) continue;
    // From (normal, offset): rotations about x and y move the normal by -y and x; the translation
    // is at the point.
    Eigen::Matrix<double, 3, 4> motion;
    motion << -normal.cross(x).transpose(), 0.0, x.transpose(), 0.0,
        -plane.point_in_world.transpose(), -1.0;
    plane.covariance = motion * covariance->second * motion.transpose();
  }
  for (size_t i = 0; i < level->frames.size(); ++i) {
    level->frames[i].world_from_camera = map.world_from_camera[i];
  }
  estimate->cost = map.solver.final_cost;
}

// The sequence's own planes.
Result FromSequence(const Sequence& sequence) {
  Result result{{}, sequence, {}};
  result.estimate.settled = true;
  for (const SupportPlane& support : sequence.planes) {
    const Plane& plane = support.plane_in_world;
    result.estimate.planes.push_back(
        {plane, -plane.offset * plane.normal, plane.normal.unitOrthogonal(), {}});
  }
  for (const Object& object : sequence.objects) {
    ObjectSupport& given = result.estimate.objects.emplace_back();
    given.plane_index = object.plane_index;
    given.reason = object.plane_index == kNoPlane ? SupportReason::kNone : SupportReason::kGiven;
  }
  return result;
}

// Throws InputError, naming the file, if there are several segments: every segment has its own
// world, up direction and planes.
void CheckOneSegment(const Sequence& sequence, const std::filesystem::path& path) {
  const int first = sequence.frames.front().segment;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    if (sequence.frames[i].segment == first) continue;
    throw InputError(fmt::format(
        "{}: /frames/{} is of segment {}, the frames before of segment {}; expected one segment "
        "where planes are estimated, or planes = given or camera_height",
        path.string(), i, sequence.frames[i].segment, first));
  }
}

Result FromBoxes(const Sequence& sequence, const PlanesOptions& options, const StageFiles& files,
                 int threads) {
  CheckOneSegment(sequence, files.at("sequence"));
  Result result;
  result.inputs = {files.at("table")};
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  const std::vector<SegmentView> views =
      ViewsOfSegments(sequence, options.verticals, files, threads, &result.inputs);
  const auto priors = ObjectPriors(sequence, table, RatioPrior::kTable);
  PlanesAndOrientation held;
  if (sequence.ground) {  // up is known
    const UpPrior up_prior = {sequence.ground->up_information, sequence.ground->up_in_world};
    auto estimate = FindPlanes(sequence, priors, up_prior, options, threads);
    if (!estimate) ThrowNoPlane(sequence.name);
    held = {std::move(*estimate), sequence};
  } else {
    held = EstimatePlanesAndOrientation(sequence, views, priors, options, threads);
  }
  if (options.refine_poses) {
    RefineWithPoses(priors, options, threads, &held.estimate, &held.level);
  }
  result.estimate = std::move(held.estimate);
  result.sequence = WithPlanes(std::move(held.level), result.estimate);
  result.sequence.frames = sequence.frames;  // odometry stays what was measured
  SetSceneAxes(views, options.upright.ViewCorrelation(), &result.sequence);
  return result;
}

// Uses the ground plane at the camera's height in every frame, independent of the trajectory.
Result FromCameraHeight(const Sequence& sequence, const PlanesOptions& options,
                        const StageFiles& files) {
  Result result;
  result.inputs = {files.at("table")};
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  result.estimate = PlanesBelowCameras(sequence, options.camera_height_m);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const auto prior = table.Find(sequence.objects[i].label);
    if (prior && prior->mount != Mount::kStanding) {
      result.estimate.objects[i].reason = SupportReason::kNone;
    }
  }
  result.sequence = WithPlanes(sequence, result.estimate);
  for (Detection& detection : result.sequence.detections) {
    detection.plane_in_camera = GroundInCamera(options.camera_height_m);
  }
  return result;
}

// A sequence that has frames, with or without planes.
Sequence ReadFrames(const std::filesystem::path& file) {
  Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
  if (sequence.frames.empty()) {
    throw NothingUsableError(file.string() + ": has no frames; expected some");
  }
  return sequence;
}

}  // namespace

void RunPlanes(const PlanesOptions& options, const StageFiles& files, int threads) {
  if (options.planes == PlaneSource::kGiven) {
    throw SettingsError(
        "planes is given; expected estimated, where_missing or camera_height (given planes need no "
        "stage)");
  }
  const Sequence sequence = ReadFrames(files.at("sequence"));
  const bool has_planes = options.planes == PlaneSource::kWhereMissing && !sequence.planes.empty();
  const Result result = has_planes ? FromSequence(sequence)
                        : options.planes == PlaneSource::kCameraHeight
                            ? FromCameraHeight(sequence, options, files)
                            : FromBoxes(sequence, options, files, threads);
  if (result.sequence.detections.empty()) {
    throw NothingUsableError(fmt::format("{}: none of {} detections is of an object on a plane",
                                         files.at("sequence").string(),
                                         sequence.detections.size()));
  }
  ArtefactInfo info = {
      .settings = OptionsToJson(options), .inputs = {files.at("sequence")}, .stage = "planes"};
  info.inputs.insert(info.inputs.end(), result.inputs.begin(), result.inputs.end());
  if (!has_planes && options.planes != PlaneSource::kCameraHeight) {
    info.findings = CheckPlaneCount(result.estimate.planes.size(), sequence.objects.size());
    std::ranges::move(CheckUp(result.estimate.orientation, result.estimate.orientations,
                              result.estimate.orientation_tilt_variance),
                      std::back_inserter(info.findings));
  }
  ReportFindings("planes", info.findings);
  // Planes are not compared with themselves.
  WritePlanes(files.at("report"),
              MakeReport(result.estimate, has_planes ? WithoutPlanes(sequence) : sequence), info);
  WriteSequence(files.at("output"), result.sequence, info);
  fmt::print("{}: {} planes of {} objects\n", sequence.name, result.estimate.planes.size(),
             sequence.objects.size());
}

namespace {

// Rows of turns.json of the dataset folder, by frame; empty where there is none, or it is of
// upright images and the cameras are of stored ones.
std::vector<TurnedImage> TurnedImages(const Sequence& sequence, const StageFiles& files,
                                      std::vector<std::filesystem::path>* inputs) {
  if (!files.contains("dataset") || sequence.image_orientation == ImageOrientation::kStored) {
    return {};
  }
  const std::filesystem::path path = files.at("dataset") / "turns.json";
  if (!std::filesystem::exists(path)) return {};
  inputs->push_back(path);
  std::vector<TurnedImage> images;
  for (const ImageTurns::Row& row : ReadTurns(path).body.images) {
    const auto frame = std::ranges::find(sequence.frames, row.image, &Frame::image);
    if (frame == sequence.frames.end()) continue;  // one without a pose
    images.push_back({static_cast<int>(frame - sequence.frames.begin()), row.scores});
  }
  return images;
}

// Prints the evidence of the scale, in the order of how much it pulls at it.
void PrintPulls(const GroundEstimate& estimate) {
  constexpr double kLeastPull = 0.01;
  std::vector<const WorldReport::ObjectRow*> pulling;
  for (const WorldReport::ObjectRow& object : estimate.objects) {
    if (object.pull && std::abs(*object.pull) >= kLeastPull) pulling.push_back(&object);
  }
  std::ranges::stable_sort(pulling, std::greater(), [](const WorldReport::ObjectRow* object) {
    return std::abs(*object->pull);
  });
  for (const WorldReport::ObjectRow* object : pulling) {
    fmt::print("  {:+.0f} % by a {} of {} boxes, {:.2f} m high{}\n",
               100.0 * std::expm1(*object->pull), object->label, object->boxes, *object->height_m,
               object->is_measured ? ", its size given"
               : object->AgreesWithScale()
                   ? ""
                   : fmt::format(", {:.2f} m by its label",
                                 *object->height_m *
                                     std::exp(*object->log_scale - estimate.scale->log_scale)));
  }
}

}  // namespace

void RunGround(const GroundOptions& options, const StageFiles& files, int threads) {
  if (options.ground == GroundSource::kGiven) {
    throw SettingsError("ground is given; expected estimated (a given world needs no stage)");
  }
  const Sequence sequence = ReadFrames(files.at("sequence"));
  CheckOneSegment(sequence, files.at("sequence"));
  ArtefactInfo info = {.settings = OptionsToJson(options),
                       .inputs = {files.at("sequence"), files.at("points"), files.at("table")},
                       .stage = "ground"};
  const Edits edits = files.contains("edits") ? ReadEdits(files.at("edits")) : Edits();
  if (files.contains("edits")) info.inputs.push_back(files.at("edits"));
  const PairEvidence pairs = ReadPairs(options.shared_points, sequence, files);
  if (options.shared_points) info.inputs.push_back(files.at("matches"));
  const std::vector<SegmentView> views =
      ViewsOfSegments(sequence, options.verticals, files, threads, &info.inputs);
  const GroundEstimate estimate = EstimateGround(
      sequence,
      WithoutMovingThings(sequence, WithoutDistortion(sequence, ReadPoints(files.at("points")))),
      views, TurnedImages(sequence, files, &info.inputs), pairs, edits,
      ReadSemanticTable(files.at("table")), options, threads);
  info.findings = CheckGround(estimate, options);
  if (!estimate.cameras_are_turned) {
    std::ranges::move(
        CheckUp(estimate.up_of_cameras.orientation, estimate.up_of_cameras.orientations,
                estimate.up_of_cameras.orientation_tilt_variance),
        std::back_inserter(info.findings));
  }
  ReportFindings("ground", info.findings);
  WriteWorld(files.at("world"), MakeReport(estimate, sequence, info.findings), info);
  WriteSequence(files.at("output"), WithGround(sequence, estimate), info);
  std::string scale_in_words = "unknown scale";
  if (const auto scale = EstimateWorldScale(estimate, info.findings)) {
    const std::string contradictions = ContradictionsInWords(*scale);
    scale_in_words = fmt::format("scale +- {:.0f} % (95 %) from {}{}{}",
                                 HalfIntervalPercent(*scale), SourcesInWords(*scale),
                                 contradictions.empty() ? "" : ", uncertain: ", contradictions);
  }
  PrintPulls(estimate);
  fmt::print("{}: up +- {:.1f} degrees (one standard deviation), {}, {} of points\n", sequence.name,
             kDegPerRad * estimate.tilt_sigma, scale_in_words,
             Counted(estimate.planes.size(), "horizontal plane"));
}

}  // namespace soslam
