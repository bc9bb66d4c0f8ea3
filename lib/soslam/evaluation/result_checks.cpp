// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/result_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "soslam/base/text.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"
#include "soslam/ground/ground_checks.h"
#include "soslam/mapping/input_alternatives.h"
#include "soslam/model/estimates.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

// An object's height relative to the median height of its label.
struct RelativeHeight {
  std::string name;  // of the object
  double log_ratio = 0.0;
  double log_sigma = 0.0;  // of its label
};

// The common factor of all objects, if the spread within labels does not account for it.
std::vector<Finding> CheckScale(const std::vector<RelativeHeight>& relative) {
  constexpr size_t kFewest = 3;
  constexpr double kSmallestFactor = 1.5;
  constexpr double kSigmas = 3.0;
  // The standard deviation of the median of n normal values is this times sigma / sqrt(n).
  constexpr double kMedianSigma = 1.25;
  if (relative.size() < kFewest) return {};
  const double log_factor = *MedianOf(CollectValues(relative, &RelativeHeight::log_ratio));
  const double sigma = kMedianSigma *
                       *MedianOf(CollectValues(relative, &RelativeHeight::log_sigma)) /
                       std::sqrt(static_cast<double>(relative.size()));
  const double least = std::max(std::log(kSmallestFactor), kSigmas * sigma);
  if (std::abs(log_factor) <= least) return {};
  return {{"scale", Severity::kWarning,
           fmt::format("{} objects are {:.3g} times as high as their labels' things (median)",
                       relative.size(), std::exp(log_factor)),
           fmt::format("a factor of {:.2f} to {:.2f}", std::exp(-least), std::exp(least)),
           "a trajectory whose unit is not the metre, as of a single camera, poses and planes that "
           "contradict the boxes, or names of classes that are not those of the boxes",
           fmt::format("multiply the translations of the trajectory by about {:.3g}; all sizes and "
                       "distances of the map are of the trajectory's unit",
                       std::exp(-log_factor))}};
}

std::vector<Finding> CheckSingleSizes(const std::vector<RelativeHeight>& relative) {
  constexpr double kMultiple = 3.0;
  constexpr double kSigmas = 3.0;
  constexpr size_t kMostNames = 5;
  std::vector<std::string> odd;
  for (const RelativeHeight& object : relative) {
    const double deviation = std::abs(object.log_ratio);
    if (deviation <= std::max(std::log(kMultiple), kSigmas * object.log_sigma)) continue;
    odd.push_back(fmt::format("{} {:.3g} times", object.name, std::exp(object.log_ratio)));
  }
  if (odd.empty()) return {};
  const size_t count = odd.size();
  if (count > kMostNames) odd.resize(kMostNames);
  return {{"object_size", Severity::kWarning,
           fmt::format("{} of {} objects are not as high as their label's things: {}{}", count,
                       relative.size(), fmt::join(odd, ", "), count > kMostNames ? ", ..." : ""),
           "at most three times as high or low, or three standard deviations of the label",
           "boxes of several things under one id, a wrong label, a wrong plane, a thing on its "
           "edge (a standing book), or views that do not tell the size",
           "look at these objects' boxes: soslam-inspect, or the report page"}};
}

// A warning on the landmarks with such half axes, if there are any; `finding` has what they are.
template <typename IsBad>
std::vector<Finding> CheckHalfAxes(const LandmarkEstimates& estimates, const IsBad& is_bad,
                                   Finding finding) {
  int landmarks = 0, bad = 0;
  for (const ObjectEstimate& object : estimates.objects) {
    if (!object.landmark_in_world) continue;
    ++landmarks;
    bad += is_bad(object.landmark_in_world->half_axes) ? 1 : 0;
  }
  if (bad == 0) return {};
  finding.found = fmt::format("{} of {} landmarks {}", bad, landmarks, finding.found);
  return {finding};
}

// Limit of the cost of boxes over what their noise gives by chance. Measured maps are below 3 with
// given ids, and below 9 with raw detections, some of whose tracks are of several things.
constexpr double kFarAbove = 10.0;

std::string FocalInWords(const Sequence& sequence, const InputAlternative& given,
                         const InputAlternative& found, double expected) {
  const double dispersion = std::max(1.0, found.box_cost / expected);
  const double log_sigma = std::abs(std::log(found.focal_factor)) /
                           std::sqrt(2.0 * (given.cost - found.cost) / dispersion);
  const double fx = sequence.CameraOf(sequence.frames.front()).fx;
  return fmt::format(
      "{:.3f} times the focal length (fx = {:.4g} in place of {:.4g} px, standard "
      "deviation {:.2g} px)",
      found.focal_factor, found.focal_factor * fx, fx, found.focal_factor * fx * log_sigma);
}

std::string PlanesInWords(const Sequence& sequence, const InputAlternative& found) {
  constexpr size_t kMostPlanes = 5;
  std::vector<std::string> planes;
  for (const auto& [index, plane] : found.planes) {
    const SupportPlane& given = sequence.planes[static_cast<size_t>(index)];
    if (LargestCorrection(plane) < 1.0) continue;
    const Eigen::Vector3d& normal = plane.plane_in_world.normal;
    const double offset = plane.plane_in_world.offset;
    planes.push_back(
        normal == given.plane_in_world.normal
            ? fmt::format(
                  "plane {} {:.3f} m {}, d = {:.3f}", given.id, std::abs(plane.height_change_m),
                  plane.height_change_m < 0.0 ? "against its normal" : "along its normal", offset)
            : fmt::format("plane {} turned by {:.1f} degrees, to the normal ({:.3f}, {:.3f}, "
                          "{:.3f}) and d = {:.3f}",
                          given.id, plane.tilt_rad * kDegPerRad, normal.x(), normal.y(), normal.z(),
                          offset));
  }
  const size_t count = planes.size();
  if (count > kMostPlanes) planes.resize(kMostPlanes);
  return fmt::format("{}{}", fmt::join(planes, "; "),
                     count > kMostPlanes ? fmt::format("; ... ({} planes)", count) : "");
}

}  // namespace

std::vector<Finding> CheckFailures(const LandmarkEstimates& estimates) {
  int tries = 0;
  int failed = 0;
  int cut_off = 0;
  std::map<std::string, int> reasons;
  const auto count = [&](bool has_failed, const std::string& reason) {
    if (has_failed && reason == kMovingObject) return;
    ++tries;
    if (!has_failed) return;
    ++failed;
    ++reasons[reason];
    if (reason == kFewerThanThreeMeasuredEdges) ++cut_off;
  };
  for (const auto& observation : estimates.observations) {
    count(observation.hypotheses.empty(), observation.failure);
  }
  for (const auto& object : estimates.objects) count(!object.landmark_in_world, object.failure);
  if (3 * failed <= tries) return {};
  Finding finding{
      "failures",
      Severity::kWarning,
      fmt::format("{} of {} tries gave no landmark: {}", failed, tries, CountsInWords(reasons)),
      "a landmark from two tries of three at least",
      "poses the other way round, planes or boxes of another convention, another camera, or too "
      "few views",
      "look at the findings of the import, then at boxes and planes in an image: soslam-inspect"};
  if (2 * cut_off > failed) {
    finding.cause = "objects that the border of the image, or what is in front of them, cuts off";
    finding.remedy =
        "nothing where other images show them whole; otherwise images from farther away";
  }
  return {finding};
}

std::vector<Finding> CheckObjectIds(const Sequence& sequence) {
  constexpr size_t kLeastBoxes = 10;
  constexpr size_t kLeastImages = 3;
  std::map<int, std::set<int>> images_of_segment;
  for (const Detection& detection : sequence.detections) {
    images_of_segment[sequence.FrameOf(detection).segment].insert(detection.frame_index);
  }
  const bool has_images = std::ranges::any_of(
      images_of_segment, [](const auto& segment) { return segment.second.size() >= kLeastImages; });
  const bool is_shared =
      std::ranges::any_of(DetectionsByObject(sequence),
                          [](const std::vector<int>& of_object) { return of_object.size() > 1; });
  if (!has_images || is_shared || sequence.detections.size() < kLeastBoxes) return {};
  return {
      {"object_ids", Severity::kWarning,
       fmt::format("none of {} objects has a second box", sequence.detections.size()),
       "boxes of the same object in several images, with one id",
       "boxes of a detector, which have no ids, or a column of another name than object_id",
       "set association = estimated in section associate of the settings, or rename the column"}};
}

std::vector<Finding> CheckLabels(const Sequence& sequence, const SemanticTable& table,
                                 const std::string& table_file) {
  std::set<std::string> all;
  for (const Detection& detection : sequence.detections) {
    all.insert(sequence.ObjectOf(detection).label);
  }
  std::vector<std::string> unknown = LabelsWithoutEntry(sequence, table);
  if (unknown.empty() || 3 * unknown.size() < all.size()) return {};
  std::vector<std::string> known;
  for (const auto& [name, prior] : table.priors) known.push_back(name);
  for (std::string& label : unknown) {
    const auto likely = LikelyMeant(NormalisedLabel(label), known);
    if (likely) label += fmt::format(" ({}?)", *likely);
  }
  return {{"labels", Severity::kWarning,
           fmt::format("{} of {} labels are not in {}: {}; {}", unknown.size(), all.size(),
                       table_file, NamesInWords(unknown, 10),
                       table.default_prior ? "its default is used" : "their objects are left out"),
           "labels of the table, which has their proportions and heights",
           "misspelt labels, another language, or things that the table does not have",
           "rename the labels (case, blanks, underscores and hyphens do not count), or add rows or "
           "aliases to the table"}};
}

std::vector<Finding> CheckSizes(const LandmarkEstimates& estimates, const Sequence& sequence,
                                const SemanticTable& table) {
  std::map<int, std::vector<double>> heights_m;  // of each object's landmarks
  for (const ObservationEstimate& observation : estimates.observations) {
    if (observation.hypotheses.empty()) continue;
    heights_m[sequence.detections[observation.detection_index].object_index].push_back(
        2.0 * observation.hypotheses.front().landmark_in_camera.half_axes.z());
  }
  for (const ObjectEstimate& object : estimates.objects) {
    if (!object.landmark_in_world) continue;
    heights_m[object.object_index] = {2.0 * object.landmark_in_world->half_axes.z()};
  }
  std::vector<RelativeHeight> relative;
  for (const auto& [index, heights] : heights_m) {
    const Object& object = sequence.objects[index];
    const auto prior = table.Find(object.label);
    if (!prior || !prior->height_m || prior->mount != Mount::kStanding ||
        prior->attitude != Attitude::kStanding) {
      continue;
    }
    relative.push_back({fmt::format("{} ({})", object.id, object.label),
                        std::log(*MedianOf(heights) / prior->height_m->median),
                        prior->height_m->log_sigma});
  }
  std::vector<Finding> findings = CheckScale(relative);
  if (findings.empty()) findings = CheckSingleSizes(relative);
  return findings;
}

std::vector<Finding> CheckDegenerate(const LandmarkEstimates& estimates) {
  constexpr double kThinnest = 1e-2;
  return CheckHalfAxes(
      estimates,
      [](const Eigen::Vector3d& axes) { return axes.minCoeff() < kThinnest * axes.maxCoeff(); },
      {"degenerate", Severity::kWarning, "are a hundred times as long as thick, or more",
       "landmarks with three axes of about one size",
       "views that do not determine all axes, where neither support nor size ratios do",
       "views from more sides, or a variant with support and ratios"});
}

std::vector<Finding> CheckCollapsed(const LandmarkEstimates& estimates) {
  constexpr double kSmallestM = 1e-3;
  return CheckHalfAxes(
      estimates, [](const Eigen::Vector3d& axes) { return axes.maxCoeff() < kSmallestM; },
      {"collapsed", Severity::kWarning, "have three half axes below 1 mm",
       "landmarks as large as things that a camera sees",
       "poses, planes or boxes that contradict each other, boxes of several things under one id, "
       "or a trajectory that is much smaller than in metres",
       "look at the findings of the import and at the boxes of these objects: soslam-inspect"});
}

std::vector<Finding> CheckInputs(const Sequence& sequence, const MapEstimate& map) {
  constexpr double kChance = 1e-3;
  constexpr double kLeastProbability = 0.05;
  if (map.input_alternatives.empty()) return {};
  const InputAlternative& given = map.input_alternatives.front();
  const double expected = map.solver.expected_box_cost;
  const auto tries = static_cast<double>(1 + 2 * (sequence.planes.size() + 1));
  std::vector<const InputAlternative*> better;
  for (const InputAlternative& found : map.input_alternatives) {
    const double dispersion = std::max(1.0, found.box_cost / expected);
    const double correction = LargestCorrection(found);
    if (correction <= 1.0 || dispersion > kFarAbove) continue;
    // The gain that is left once what is given is corrected by the least that matters: the cost is
    // a parabola along the way to the minimum.
    const double gain = (given.cost - found.cost) * std::pow(1.0 - 1.0 / correction, 2);
    const double ratio = 2.0 * gain / (found.degrees * dispersion);
    const bool is_chance =
        !(gain > 0.0) || FisherTail(ratio, found.degrees, 2.0 * expected) > kChance / tries;
    if (!is_chance) better.push_back(&found);
  }
  if (better.empty()) return {};
  const InputAlternative& lowest = **std::ranges::min_element(
      better, {}, [](const InputAlternative* found) { return found->cost; });
  const double dispersion = std::max(1.0, lowest.box_cost / expected);
  // Schwarz's approximation of how probable the alternatives are against each other.
  const auto log_weight = [&](const InputAlternative* found) {
    return (lowest.cost - found->cost) / dispersion -
           0.5 * found->degrees * std::log(2.0 * expected);
  };
  std::ranges::stable_sort(better, std::greater(), log_weight);
  const InputAlternative& best = *better.front();
  double weights = 0.0;
  for (const InputAlternative* found : better) {
    weights += std::exp(log_weight(found) - log_weight(&best));
  }
  const auto in_words = [&](const InputAlternative& found) {
    return found.planes.empty() ? FocalInWords(sequence, given, found, expected)
                                : PlanesInWords(sequence, found);
  };
  std::string others;
  for (const InputAlternative* found : better) {
    const double probability = std::exp(log_weight(found) - log_weight(&best)) / weights;
    if (found == &best || probability < kLeastProbability) continue;
    others += fmt::format("; or (probability {:.2f}) with {}", probability, in_words(*found));
  }
  const bool is_focal = best.planes.empty();
  return {
      {is_focal ? "focal_length" : "support_planes", Severity::kWarning,
       fmt::format("the boxes fit best with {}: they cost {:.3g} times what their noise gives "
                   "by chance in place of {:.3g} times{}",
                   in_words(best), best.box_cost / expected, given.box_cost / expected, others),
       fmt::format("no better fit than chance gives once in {:g} maps", 1.0 / kChance),
       is_focal ? "intrinsics of another camera, of another image size or of cropped images"
                : "planes of another world, unit or recording, or badly measured; objects that "
                  "stand on something else; or what looks alike: a trajectory of another scale, "
                  "a principal point that is far off",
       is_focal ? "calibrate the camera, or estimate it along with the poses (soslam-reconstruct)"
                : "compare planes.json and its unit with the trajectory, and the objects' planes "
                  "with the images; or let planes be estimated: settings {\"planes\": {\"planes\": "
                  "\"estimated\"}}"}};
}

std::vector<Finding> CheckCost(const SolverSummary& solver) {
  if (solver.box_cost <= kFarAbove * solver.expected_box_cost) return {};
  return {{"cost", Severity::kWarning,
           fmt::format("the boxes cost {:.4g}, {:.3g} times what their noise gives by chance",
                       solver.box_cost, solver.box_cost / solver.expected_box_cost),
           fmt::format("less than {:g} times", kFarAbove),
           "boxes of several things under one id, poses or planes that contradict the boxes, or "
           "another camera",
           "look at the findings of the import and at the boxes of the objects with the largest "
           "errors: soslam-inspect, or the report page"}};
}

std::vector<Finding> CheckPoseCorrections(const Sequence& sequence,
                                          const std::vector<Rigid3d>& world_from_camera,
                                          const OdometryNoise& noise) {
  constexpr double kNormalQuantile = 2.3263;  // 99 %
  double sum = 0.0;
  int degrees = 0;
  for (size_t i = 1; i < sequence.frames.size(); ++i) {
    const Frame& first = sequence.frames[i - 1];
    const Frame& second = sequence.frames[i];
    if (first.segment != second.segment) continue;
    const OdometryResidual odometry(first.world_from_camera.Inverse() * second.world_from_camera,
                                    noise);
    sum += odometry.Values(world_from_camera[i - 1], world_from_camera[i]).squaredNorm();
    degrees += OdometryResidual::kNumResiduals;
  }
  if (degrees == 0) return {};
  const double bound = degrees * ChiSquareQuantile(degrees, kNormalQuantile);
  if (sum <= bound) return {};
  return {
      {"pose_corrections", Severity::kWarning,
       fmt::format("the motions between {} pairs of frames differ from the odometry by a sum of "
                   "{:.4g} squared standard deviations",
                   degrees / OdometryResidual::kNumResiduals, sum),
       fmt::format("at most {:.4g}, which chance exceeds once in 100 times", bound),
       "odometry that errs more than its standard deviations say, boxes of a wrong object, objects "
       "that move, or planes that contradict the odometry",
       "set the standard deviations of the odometry to its errors, or hold_poses where poses are "
       "exact; look at boxes and planes: soslam-inspect"}};
}

std::vector<Finding> CheckUp(CameraOrientation orientation,
                             const std::vector<TriedOrientation>& orientations,
                             double tilt_variance) {
  if (tilt_variance == 0.0) return {};
  std::vector<std::string> ways;
  for (const TriedOrientation& tried : orientations) {
    ways.push_back(fmt::format("{} {:.2g}", NameOf(tried.orientation), tried.probability));
  }
  return {{kUpDirectionCheck, Severity::kWarning,
           fmt::format("cameras are taken to be held {}; probabilities: {}", NameOf(orientation),
                       fmt::join(ways, ", ")),
           "one way to hold them that explains the boxes much better than others",
           "few objects, or cameras that were rolled or look down",
           "take images with the camera held level that show upright edges, such as door frames; "
           "or give planes.json, where up in the world of the poses is known"}};
}

std::vector<Finding> CheckPlaneCount(size_t planes, size_t objects) {
  constexpr size_t kFewest = 3;
  if (planes < kFewest || 4 * planes <= 3 * objects) return {};
  return {
      {"plane_count", Severity::kWarning, fmt::format("{} planes of {} objects", planes, objects),
       "several objects on each plane",
       "an up direction that is wrong, as of cameras that were rolled, or poses that contradict "
       "the boxes",
       "look at up and its standard deviation in planes.json; give planes.json where it is known"}};
}

std::string DoubtOfUp(const std::vector<Finding>& findings) {
  const std::map<std::string, std::string> doubts = {
      {kCamerasTurnedCheck, "the photos are turned in many ways"},
      {kUpDirectionCheck, "objects look alike in other ways to hold the camera"}};
  std::vector<std::string> words;
  for (const Finding& finding : findings) {
    const auto doubt = doubts.find(finding.check);
    if (doubt != doubts.end()) words.push_back(doubt->second);
  }
  return fmt::format("{}", fmt::join(words, ", and "));
}

}  // namespace soslam
