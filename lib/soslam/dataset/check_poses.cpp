// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <vector>

#include "soslam/dataset/dataset_checks.h"
#include "soslam/evaluation/trajectory_error.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {
namespace {

// An alternative convention of a pose that was read as world_from_camera with quaternion qx qy qz
// qw. The true pose is that of the applied function, turned by `read_from_camera`.
struct PoseReading {
  const char* name;  // "the poses are the inverse, camera_from_world"
  const char* cause;
  const char* remedy;
  Rigid3d (*Apply)(const Rigid3d& as_read);
  Eigen::Quaterniond read_from_camera = Eigen::Quaterniond::Identity();
  bool are_boxes_mirrored = false;  // boxes are also mirrored left to right
  bool is_turned_in_body = false;   // a rotation that a camera may also have in a body

  Rigid3d WorldFromCamera(const Rigid3d& as_read) const {
    const Rigid3d pose = Apply(as_read);
    return {pose.rotation * read_from_camera, pose.translation};
  }
};

Rigid3d Inverted(const Rigid3d& pose) { return pose.Inverse(); }

// Quaternion w x y z that was read as x y z w.
Rigid3d WithScalarFirst(const Rigid3d& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  return {Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

Rigid3d ScalarFirstInverted(const Rigid3d& pose) { return WithScalarFirst(pose).Inverse(); }

Rigid3d WithInverseRotation(const Rigid3d& pose) {
  return {pose.rotation.conjugate(), pose.translation};
}

// Pose with camera centre -R t, for a translation t of the inverse pose.
Rigid3d WithInverseTranslation(const Rigid3d& pose) {
  return {pose.rotation, -(pose.rotation * pose.translation)};
}

// Pose with a translation that was inverted although it was the centre.
Rigid3d WithCentreInverted(const Rigid3d& pose) {
  return {pose.rotation, pose.Inverse().translation};
}

Rigid3d WithCentreMirrored(const Rigid3d& pose) {
  const Eigen::Vector3d& t = pose.translation;
  return {pose.rotation, {-t.x(), t.y(), t.z()}};
}

Rigid3d WithCentreSwapped(const Rigid3d& pose) {
  const Eigen::Vector3d& t = pose.translation;
  return {pose.rotation, {t.x(), t.z(), t.y()}};
}

Rigid3d AsRead(const Rigid3d& pose) { return pose; }

// Rotations of the camera's axes (x right, y down, z forward) in those of other conventions.
const Eigen::Quaterniond kAsCamera = Eigen::Quaterniond::Identity();
const Eigen::Quaterniond kAsOpenGl(0.0, 1.0, 0.0, 0.0);     // x right, y up, z backward
const Eigen::Quaterniond kAsRosBody(0.5, -0.5, 0.5, -0.5);  // x forward, y left, z up
const Eigen::Quaterniond kUpsideDown(0.0, 0.0, 0.0, 1.0);
const Eigen::Quaterniond kQuarterTurned(0.5 * std::numbers::sqrt2, 0.0, 0.0,
                                        0.5 * std::numbers::sqrt2);

constexpr bool kMirrored = true;
constexpr bool kTurnedInBody = true;
constexpr const char* kTurned =
    "images or boxes that are turned against the poses, or another camera's axes";

const std::array kReadings = {
    PoseReading{"the poses are the inverse, camera_from_world",
                "poses the other way round, as COLMAP has them", "invert the poses", &Inverted},
    PoseReading{"the poses are with qw first", "quaternions qw qx qy qz",
                "write quaternions as qx qy qz qw", &WithScalarFirst},
    PoseReading{"the poses are the inverse with qw first", "poses of COLMAP's images.txt",
                "write quaternions as qx qy qz qw, and invert the poses", &ScalarFirstInverted},
    PoseReading{"the poses are those of a camera with y up and z backward",
                "cameras of OpenGL, as NeRFs have them",
                "turn the cameras by half a turn about their x axis", &AsRead, kAsOpenGl},
    PoseReading{"the poses are the inverse of those of a camera with y up and z backward",
                "view matrices of OpenGL",
                "invert the poses, then turn the cameras by half a turn about their x axis",
                &Inverted, kAsOpenGl},
    PoseReading{"the poses are with qw first and of a camera with y up and z backward",
                "cameras of OpenGL, with quaternions qw qx qy qz",
                "write quaternions as qx qy qz qw, and turn the cameras by half a turn about their "
                "x axis",
                &WithScalarFirst, kAsOpenGl},
    PoseReading{"the poses are with the inverse rotation",
                "rotation matrices that were transposed, or rotations of camera_from_world beside "
                "the centres of the cameras",
                "transpose the rotations, and keep the translations", &WithInverseRotation},
    PoseReading{"the poses are with the translation of camera_from_world",
                "translations of camera_from_world beside rotations of world_from_camera",
                "give the centre of the camera, -R t, as the translation", &WithInverseTranslation},
    PoseReading{"the poses are with the centre inverted once more",
                "centres of cameras that were taken for the translation of camera_from_world",
                "keep the translations when the rotations are inverted", &WithCentreInverted},
    PoseReading{"the poses are turned by half a turn about the camera's z axis", kTurned,
                "turn the cameras by half a turn about their z axis, or the boxes with the images",
                &AsRead, kUpsideDown, !kMirrored, kTurnedInBody},
    PoseReading{"the poses are turned by a quarter about the camera's z axis", kTurned,
                "turn the cameras by 90 degrees about their z axis, or the boxes with the images",
                &AsRead, kQuarterTurned, !kMirrored, kTurnedInBody},
    PoseReading{"the poses are turned back by a quarter about the camera's z axis", kTurned,
                "turn the cameras by -90 degrees about their z axis, or the boxes with the images",
                &AsRead, kQuarterTurned.conjugate(), !kMirrored, kTurnedInBody},
    PoseReading{"the poses are those of a body with x forward, y left and z up",
                "poses of a robot's body, as ROS has them",
                "give the poses of the camera, with x right, y down and z forward", &AsRead,
                kAsRosBody, !kMirrored, kTurnedInBody},
    PoseReading{"boxes are mirrored left to right",
                "images or boxes are mirrored, as selfie cameras do, or poses of a left-handed "
                "world",
                "mirror the boxes (x to width - 1 - x) or take images that are not mirrored",
                &AsRead, kAsCamera, kMirrored},
    PoseReading{"boxes are mirrored top to bottom",
                "boxes with y up, or poses of a left-handed world, as Unity has them",
                "write boxes with y down, and poses of a right-handed world, camera y down",
                &AsRead, kUpsideDown, kMirrored},
    PoseReading{"the poses are with x of the other sign",
                "translations of a left-handed world beside rotations of a right-handed one",
                "turn the sign of the translations' x", &WithCentreMirrored},
    PoseReading{"the poses are with y and z swapped",
                "translations with y and z swapped, beside rotations that are not",
                "swap y and z of the translations", &WithCentreSwapped}};

// True if the cameras rotate so far that moving objects cannot be mistaken for another convention
// of the poses.
bool DoCamerasTurn(const ImportView& view) {
  constexpr double kFarDeg = 10.0;
  std::optional<Rigid3d> first;
  for (const ListedFrame& listed : view.content.frames) {
    const auto pose = listed.Pose();
    if (!pose) continue;
    if (!first) first = pose;
    if (kDegPerRad * pose->rotation.angularDistance(first->rotation) > kFarDeg) return true;
  }
  return false;
}

// Searches for the best reading of the poses or order of the frames. Under a wrong one the rays to
// objects diverge; under the right one they meet to within a degree.
std::vector<Finding> CheckReadings(const ImportView& view,
                                   const std::vector<TrackedObject>& objects,
                                   const RayError& as_read) {
  constexpr double kFitsDeg = 1.0, kMuchBetter = 0.25;
  if (as_read.median_deg <= kFitsDeg) return {};
  // Rays that meet behind the cameras may come from objects that move faster than the cameras.
  const bool is_of_still_things = as_read.median_deg <= 90.0 || DoCamerasTurn(view);
  std::vector<Finding> best;
  double best_deg = std::min(kFitsDeg, kMuchBetter * as_read.median_deg);
  // `error`: what remains once the mistake is corrected.
  const auto consider = [&](const char* name, const char* cause, const char* remedy, bool is_order,
                            const std::optional<RayError>& error) {
    if (!IsComparable(error, as_read) || error->median_deg >= best_deg) return;
    best_deg = error->median_deg;
    best = {{is_order ? kFrameOrder : kPoseConvention,
             !is_order && is_of_still_things ? Severity::kError : Severity::kWarning,
             fmt::format("things are {:.2f} degrees from where they are seen (median), but {:.2f} "
                         "if {}",
                         as_read.median_deg, best_deg, name),
             is_order ? "images, poses and boxes in the order in which the camera took them"
                      : "poses world_from_camera, camera z forward, quaternion qx qy qz qw; "
                        "things that stand still",
             cause, remedy}};
  };
  std::vector<TrackedObject> mirrored = objects;
  for (TrackedObject& object : mirrored) {
    for (TrackedRay& ray : object.rays) ray.ray_in_camera.x() *= -1.0;
  }
  for (const PoseReading& reading : kReadings) {
    if (reading.is_turned_in_body && view.content.may_have_poses_of_body) continue;
    const auto pose_as_meant = [&](size_t frame) -> std::optional<Rigid3d> {
      const auto pose = view.content.frames[frame].Pose();
      return pose ? std::optional(reading.WorldFromCamera(*pose)) : std::nullopt;
    };
    consider(reading.name, reading.cause, reading.remedy, false,
             MedianRayError(reading.are_boxes_mirrored ? mirrored : objects, pose_as_meant));
  }
  // `frame_meant`: for each frame, that whose pose belongs to its boxes.
  const auto consider_order = [&](const char* name, const char* cause, const char* remedy,
                                  const std::vector<size_t>& frame_meant) {
    consider(name, cause, remedy, true, MedianRayError(objects, [&](size_t frame) {
               return PoseOfOther(view, frame, frame_meant[frame]);
             }));
  };
  std::vector<size_t> reversed(view.content.frames.size());
  std::iota(reversed.rbegin(), reversed.rend(), size_t{0});
  std::vector<size_t> of_strings(reversed.rbegin(), reversed.rend());  // 0, 1, 10, 11, 2, ...
  std::ranges::sort(of_strings, {}, [](size_t frame) { return std::to_string(frame); });
  std::vector<size_t> from_strings(of_strings.size());
  for (size_t i = 0; i < of_strings.size(); ++i) from_strings[of_strings[i]] = i;
  constexpr const char* kAsStrings = "numbers that were sorted as strings, 10 before 2";
  consider_order("the poses are in reversed order",
                 "poses or boxes from the last image to the first",
                 "reverse the poses or the frames of the detections", reversed);
  consider_order("boxes are in the order of strings", kAsStrings,
                 "sort the images or boxes by number, or write numbers with leading zeros",
                 of_strings);
  consider_order("the poses are in the order of strings", kAsStrings,
                 "sort the images or poses by number, or write numbers with leading zeros",
                 from_strings);
  return best;
}

std::string InWords(const TrajectoryGap& gap) {
  return fmt::format("{:.2f} m and {:.1f} degrees", gap.translation_m, gap.rotation_deg);
}

std::vector<PosePair> ReadAs(const PoseReading& reading, std::vector<PosePair> pairs) {
  for (PosePair& pair : pairs) pair.estimated = reading.WorldFromCamera(pair.estimated);
  return pairs;
}

// Pairs after moving the estimated trajectory so that its first pose is the true one.
std::vector<PosePair> AlignedAtFirst(std::vector<PosePair> pairs) {
  const Rigid3d true_from_estimated = pairs.front().truth * pairs.front().estimated.Inverse();
  for (PosePair& pair : pairs) pair.estimated = true_from_estimated * pair.estimated;
  return pairs;
}

Advice AdviceOnTrajectory(const std::vector<PosePair>& pairs, double extent_m) {
  const auto fits = [&](const std::vector<PosePair>& read) {
    return IsDrift(ComputeGap(read), extent_m) && HaveSameScale(read);
  };
  for (const PoseReading& reading : kReadings) {
    const auto read = ReadAs(reading, pairs);
    if (!fits(read)) continue;
    return {fmt::format("{} (the gap is {} if the poses are {})", reading.cause,
                        InWords(ComputeGap(read)), reading.name),
            reading.remedy};
  }
  if (fits(AlignedAtFirst(pairs))) {
    return {"odometry in a world of its own, as of SLAM, beside a true one", "set align_odometry"};
  }
  for (const PoseReading& reading : kReadings) {
    if (!fits(AlignedAtFirst(ReadAs(reading, pairs)))) continue;
    return {fmt::format("{}, in a world of its own", reading.cause),
            fmt::format("{}; set align_odometry", reading.remedy)};
  }
  return {"poses of another recording, of another scale, or with a convention of their own",
          "give poses world_from_camera, in metres, quaternion qx qy qz qw, and set "
          "align_odometry where their world is their own"};
}

}  // namespace

std::vector<Finding> CheckPoses(const ImportView& view) {
  constexpr size_t kFewestRays = 15;
  constexpr double kFitsDeg = 1.0;
  constexpr double kLargestShare = 0.2;  // of the size of boxes
  constexpr size_t kFewestObjects = 3;
  const std::vector<TrackedObject> objects = TrackedObjects(view);
  auto as_read =
      MedianRayError(objects, [&](size_t frame) { return view.content.frames[frame].Pose(); });
  if (as_read && as_read->rays < kFewestRays) as_read.reset();
  std::vector<Finding> findings;
  if (as_read) findings = CheckReadings(view, objects, *as_read);
  if (findings.empty() && as_read) findings = CheckLag(view, objects, *as_read);
  if (!findings.empty()) return findings;
  const bool do_fit = as_read && as_read->median_deg <= kFitsDeg;
  if (view.content.may_have_poses_of_body && !do_fit) {
    return {{kPoseConvention, Severity::kWarning,
             "EuRoC's poses are taken for those of the camera" +
                 (as_read ? fmt::format(", but things are {:.1f} degrees from where they are then "
                                        "seen (median)",
                                        as_read->median_deg)
                          : ""),
             "the camera's place in the body (T_BS), and things to within a degree where they are "
             "seen",
             "poses of a body that is not the camera, as an IMU",
             std::string("camera_file: the camera's sensor.yaml, with T_BS") +
                 (as_read ? "" : "; nothing where the poses are those of the camera")}};
  }
  if (!as_read || as_read->median_share <= kLargestShare || as_read->objects < kFewestObjects) {
    return {};
  }
  // If objects are right from the true poses, the estimates drift, which CheckTruth reports.
  const auto from_truth = MedianRayError(objects, [&](size_t frame) {
    return view.content.frames[frame].frame.true_world_from_camera;
  });
  if (IsComparable(from_truth, *as_read) && from_truth->median_share <= kLargestShare) return {};
  return {{kBoxesAgainstPoses, Severity::kWarning,
           fmt::format("{} things are {:.2f} degrees from where they are seen, {:.2g} times half "
                       "the diagonal of their boxes (medians)",
                       as_read->objects, as_read->median_deg, as_read->median_share),
           fmt::format("at most {:g} times; things that stand still", kLargestShare),
           "poses, the order of frames, or ids contradict the boxes; or poses that drift far",
           "look at the boxes of one id in several images: soslam-inspect; then at poses and time "
           "stamps"}};
}

std::vector<Finding> CheckTruth(const ImportView& view) {
  constexpr size_t kFewest = 3;
  // Their worlds differ by a similarity, which evaluation finds.
  if (view.sequence.odometry_world == OdometryWorld::kOwnWithScale) return {};
  std::vector<PosePair> pairs;
  for (const ListedFrame& listed : view.content.frames) {
    // Each segment has its own world.
    if (listed.frame.segment != view.content.frames.front().frame.segment) break;
    const auto& truth = listed.frame.true_world_from_camera;
    if (listed.has_pose && truth) pairs.push_back({listed.frame.world_from_camera, *truth});
  }
  if (pairs.size() < kFewest) return {};
  const TrajectoryGap gap = ComputeGap(pairs);
  const double extent_m = ComputeExtent(pairs, &PosePair::truth);
  if (AreInOneWorld(pairs)) return {};
  const Advice advice = AdviceOnTrajectory(pairs, extent_m);
  return {{"trajectory_against_truth", Severity::kWarning,
           fmt::format("estimated and true poses are {} apart (median of {} frames; {} at the "
                       "first one), of a camera that moves by {:.2f} m",
                       InWords(gap), pairs.size(), InWords(ComputeGap({pairs.front()})), extent_m),
           "two trajectories of one world, apart by no more than drift", advice.cause,
           advice.remedy}};
}

}  // namespace soslam
