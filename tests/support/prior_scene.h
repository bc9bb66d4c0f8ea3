// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/base/upper_median.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/triangulation.h"
#include "soslam/ground/estimate_ground.h"
#include "soslam/synthesis/simulate.h"
#include "support/lists.h"
#include "support/looking_at.h"

namespace soslam {

// Room with objects whose labels and sizes are drawn from a semantic table, on its floor and on a
// table, seen by a person who walks around them.
struct PriorScene {
  Sequence sequence;  // each box is of an object of its own; in a world of any frame and unit
  std::vector<MapPoint> points;
  std::vector<Eigen::Vector3d> sizes_m;  // depth, width, height, by true_object_id
  double metres_per_unit = 1.0;
  Eigen::Vector3d up_in_world;
  std::vector<double> plane_heights_m;  // of planes with such objects, ascending
  double median_camera_height_m = 0.0;
  int objects = 0;               // with three boxes at least
  double prior_log_sigma = 0.0;  // of the scale, by that many independent objects
};

struct PriorSceneOptions {
  int objects = 8;  // in addition to the table
  bool has_table = true;
  double roll_sigma_deg = 2.0;
  double wrong_label_probability = 0.0;  // of an object, in all of its boxes
};

// Furniture and things of rooms.
inline const std::vector<std::string> kPriorSceneLabels = {
    "armchair", "chair",    "sofa",       "nightstand",      "stool",       "suitcase",
    "trunk",    "backpack", "trash can",  "bookcase",        "crate",       "wardrobe",
    "piano",    "cup",      "bottle",     "washing machine", "bowl",        "microwave",
    "vase",     "speaker",  "teddy bear", "printer",         "milk carton", "radio",
    "monitor",  "laptop",   "toaster",    "potted plant"};

class PriorSceneBuilder {
 public:
  PriorSceneBuilder(const SemanticTable& table, unsigned seed, const PriorSceneOptions& options)
      : table_(table), options_(options), random_(seed) {}

  PriorScene Build() {
    PlaceObjects();
    MakePoses();
    MakeBoxes();
    MakePoints();
    TurnWorld();
    return std::move(scene_);
  }

 private:
  static constexpr int kFrames = 40;
  static constexpr double kPixelSigma = 0.7;

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double Normal() { return normal_(random_); }

  Eigen::Vector3d DrawHalfAxes(const ShapePrior& prior) {
    const double half =
        0.5 * prior.height_m->median * std::exp(prior.height_m->log_sigma * Normal());
    const double first = Normal();
    const double r = prior.log_correlation;
    const double second = r * first + std::sqrt(1.0 - r * r) * Normal();
    return {half * prior.ratio.x() * std::exp(prior.log_sigma.x() * first),
            half * prior.ratio.y() * std::exp(prior.log_sigma.y() * second), half};
  }

  static Shape ShapeOf(const ShapeExponents& exponents) {
    if (exponents.horizontal < 1.7) return Shape::kBox;
    return exponents.vertical < 1.7 ? Shape::kCylinder : Shape::kEllipsoid;
  }

  const std::string& DrawLabel() {
    const auto index =
        static_cast<size_t>(Uniform(0.0, static_cast<double>(kPriorSceneLabels.size())));
    return kPriorSceneLabels[std::min(index, kPriorSceneLabels.size() - 1)];
  }

  // False if there is no room.
  bool Place(const std::string& label, const Eigen::Vector3d& half_axes, double plane_height,
             double min_radius, double max_radius) {
    const double size = half_axes.head<2>().norm();
    for (int attempt = 0; attempt < 100; ++attempt) {
      const double angle = Uniform(-std::numbers::pi, std::numbers::pi);
      const double radius = Uniform(min_radius, max_radius);
      const Eigen::Vector2d at(radius * std::cos(angle), radius * std::sin(angle));
      const bool is_free = std::ranges::none_of(bodies_, [&](const Landmark& body) {
        const double base = body.Centre().z() - body.half_axes.z();
        return std::abs(base - plane_height) < 0.01 &&
               (body.Centre().head<2>() - at).norm() < size + body.half_axes.head<2>().norm();
      });
      if (!is_free) continue;
      Landmark landmark;
      landmark.frame_from_object.rotation =
          UprightRotation(Eigen::Vector3d::UnitZ(), Uniform(-std::numbers::pi, std::numbers::pi));
      landmark.frame_from_object.translation << at, plane_height + half_axes.z();
      landmark.half_axes = half_axes;
      landmark.shape_exponents = ExponentsOf(ShapeOf(table_.Find(label)->shape_exponents));
      bodies_.push_back(landmark);
      scene_.sizes_m.push_back(2.0 * half_axes);
      const bool is_wrong = options_.wrong_label_probability > 0.0 &&
                            Uniform(0.0, 1.0) < options_.wrong_label_probability;
      body_labels_.push_back(is_wrong ? DrawLabel() : label);
      return true;
    }
    return false;
  }

  void PlaceObjects() {
    if (options_.has_table) {
      const Eigen::Vector3d half_axes = DrawHalfAxes(*table_.Find("dining table"));
      Place("dining table", half_axes, 0.0, 0.0, 0.01);
      table_height_ = 2.0 * half_axes.z();
      table_radius_ = std::min(half_axes.x(), half_axes.y());
    }
    for (int i = 0; i < options_.objects; ++i) {
      const std::string& label = DrawLabel();
      const Eigen::Vector3d half_axes = DrawHalfAxes(*table_.Find(label));
      const bool is_small = options_.has_table && half_axes.maxCoeff() < 0.25;
      if (is_small) {
        const double radius = table_radius_ - half_axes.head<2>().norm();
        if (radius > 0.0) Place(label, half_axes, table_height_, 0.0, radius);
      } else {
        Place(label, half_axes, 0.0, 0.8, 2.5);
      }
    }
  }

  void MakePoses() {
    const double begin = Uniform(0.0, 2.0 * std::numbers::pi);
    const double extent = Uniform(1.0, 2.5);  // rad
    const double eye = Uniform(1.2, 1.7);
    for (int i = 0; i < kFrames; ++i) {
      const double angle = begin + extent * i / kFrames;
      const double radius = 4.0 + 0.5 * std::sin(3.0 * angle);
      const Eigen::Vector3d position(radius * std::cos(angle), radius * std::sin(angle),
                                     eye + 0.1 * std::sin(5.0 * angle));
      const Eigen::Vector3d target(0.6 * std::cos(2.0 * angle), 0.6 * std::sin(3.0 * angle), 0.5);
      const Rigid3d level = LookingAt(position, target);
      const double roll = options_.roll_sigma_deg * kRadPerDeg * Normal();
      Frame frame;
      frame.id = i;
      frame.timestamp = 0.1 * i;
      frame.image = std::to_string(i) + ".png";
      frame.world_from_camera = {
          (level.rotation * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ())).normalized(),
          position};
      scene_.sequence.frames.push_back(frame);
    }
    scene_.median_camera_height_m =
        UpperMedian(Fields(scene_.sequence.frames, [](const Frame& frame) {
          return frame.world_from_camera.translation.z();
        }));
    scene_.sequence.name = "prior_scene";
    scene_.sequence.camera = {640, 480, 500.0, 500.0, 319.5, 239.5};
  }

  // The nearest surface on a ray: depth along the direction.
  std::optional<double> Cast(const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction) const {
    constexpr double kWall = 5.0;
    std::optional<double> nearest;
    const auto add = [&](double depth) {
      if (depth > 1e-6 && (!nearest || depth < *nearest)) nearest = depth;
    };
    if (direction.z() < 0.0) add(-origin.z() / direction.z());
    for (int axis = 0; axis < 2; ++axis) {
      add((kWall - origin(axis)) / direction(axis));
      add((-kWall - origin(axis)) / direction(axis));
    }
    for (const Landmark& body : bodies_) {
      const auto depth = NearestIntersection(body, origin, direction);
      if (depth) add(*depth);
    }
    return nearest;
  }

  // None where the point is hidden or outside the image.
  std::optional<Eigen::Vector2d> PixelOf(const Frame& frame, const Eigen::Vector3d& point) const {
    const auto pixel = scene_.sequence.camera.Project(frame.world_from_camera.Inverse() * point);
    if (!pixel || !scene_.sequence.camera.IsInside(*pixel)) return std::nullopt;
    const Eigen::Vector3d& origin = frame.world_from_camera.translation;
    const auto depth = Cast(origin, point - origin);
    return depth && *depth > 0.999 ? pixel : std::nullopt;
  }

  std::optional<Box> DrawBox(const Frame& frame, size_t body) {
    const Camera& camera = scene_.sequence.camera;
    const auto exact =
        ExactOutline(camera, Transform(frame.world_from_camera.Inverse(), bodies_[body]));
    if (!exact || !(DistanceToBorder(*exact, camera.width, camera.height) > 3.0) ||
        exact->Width() < 10.0 || exact->Height() < 10.0 ||
        !CentreIsVisible(bodies_, static_cast<int>(body), frame.world_from_camera.translation)) {
      return std::nullopt;
    }
    const double x = 0.015 * exact->Width() + 0.7, y = 0.015 * exact->Height() + 0.7;
    return Box{exact->x_min + x * Normal(), exact->y_min + y * Normal(),
               exact->x_max + x * Normal(), exact->y_max + y * Normal()};
  }

  void MakeBoxes() {
    std::vector<int> boxes(bodies_.size());
    Sequence& sequence = scene_.sequence;
    for (size_t i = 0; i < sequence.frames.size(); ++i) {
      for (size_t k = 0; k < bodies_.size(); ++k) {
        const auto box = DrawBox(sequence.frames[i], k);
        if (!box || Uniform(0.0, 1.0) < 0.2) continue;
        Detection detection;
        detection.frame_index = static_cast<int>(i);
        detection.object_index = static_cast<int>(sequence.objects.size());
        detection.score = Uniform(0.4, 0.95);
        detection.box = *box;
        detection.true_object_id = static_cast<int>(k);
        sequence.objects.push_back({detection.object_index, body_labels_[k], kNoPlane, {}});
        sequence.detections.push_back(detection);
        ++boxes[k];
      }
    }
    double information = 0.0;
    std::set<double> planes;
    for (size_t k = 0; k < bodies_.size(); ++k) {
      if (boxes[k] < 3) continue;
      ++scene_.objects;
      const Landmark& landmark = bodies_[k];
      planes.insert(landmark.Centre().z() - landmark.half_axes.z() > 0.5 * table_height_ &&
                            table_height_ > 0.0
                        ? table_height_
                        : 0.0);
      information += std::pow(table_.Find(body_labels_[k])->height_m->log_sigma, -2.0);
    }
    scene_.plane_heights_m.assign(planes.begin(), planes.end());
    scene_.prior_log_sigma = 1.0 / std::sqrt(information);
  }

  MapPoint Seen(const Eigen::Vector3d& point) const {
    MapPoint result;
    result.position_in_world = point;
    result.reprojection_error_px = kPixelSigma;
    for (const Frame& frame : scene_.sequence.frames) {
      const auto pixel = PixelOf(frame, point);
      if (pixel) result.observations.push_back({frame.id, *pixel});
    }
    return result;
  }

  // Directions in which a frame has points: anywhere, and on the table, whose top has texture.
  Eigen::Vector3d DrawRay(const Frame& frame, bool on_table) {
    if (!on_table) {
      return frame.world_from_camera.rotation *
             scene_.sequence.camera.Ray({Uniform(0.0, 639.0), Uniform(0.0, 479.0)});
    }
    const double x = Uniform(-table_radius_, table_radius_);
    const double y = Uniform(-table_radius_, table_radius_);
    return Eigen::Vector3d(x, y, table_height_) - frame.world_from_camera.translation;
  }

  void MakePoints() {
    constexpr int kPerFrame = 35;
    constexpr double kOutlierProbability = 0.1;
    const int on_table = options_.has_table ? 10 : 0;
    std::vector<MapPoint> points;
    for (const Frame& frame : scene_.sequence.frames) {
      for (int i = 0; i < kPerFrame; ++i) {
        const Eigen::Vector3d ray = DrawRay(frame, i < on_table);
        const Eigen::Vector3d& origin = frame.world_from_camera.translation;
        const auto depth = Cast(origin, ray);
        if (!depth) continue;
        MapPoint point = Seen(origin + *depth * ray);
        if (point.observations.size() >= 3) points.push_back(std::move(point));
      }
    }
    for (MapPoint& point : points) {
      std::vector<PointView> views;
      for (PointObservation& observation : point.observations) {
        observation.pixel += kPixelSigma * Eigen::Vector2d(Normal(), Normal());
        const Frame& frame = scene_.sequence.frames[*FindFrameIndex(scene_.sequence, observation)];
        views.push_back(
            {scene_.sequence.camera, frame.world_from_camera.Inverse(), observation.pixel});
      }
      const auto triangulated = Triangulate(views, 10.0 * kPixelSigma);
      if (!triangulated) continue;
      point.position_in_world = triangulated->position_in_world;
      if (Uniform(0.0, 1.0) < kOutlierProbability) {
        const Eigen::Vector3d origin = views.front().camera_from_world.Inverse().translation;
        point.position_in_world = origin + Uniform(0.5, 1.5) * (point.position_in_world - origin);
      }
      scene_.points.push_back(std::move(point));
    }
  }

  void TurnWorld() {
    Similarity world_from_room;  // the room has z up, metres, its floor at z = 0
    world_from_room.scale = std::exp(Uniform(-3.0, 3.0));
    world_from_room.rigid.rotation =
        Eigen::Quaterniond(Normal(), Normal(), Normal(), Normal()).normalized();
    world_from_room.rigid.translation = {10.0 * Normal(), 10.0 * Normal(), 10.0 * Normal()};
    scene_.sequence = Transformed(world_from_room, scene_.sequence);
    scene_.points = Transformed(world_from_room, scene_.points);
    scene_.metres_per_unit = 1.0 / world_from_room.scale;
    scene_.up_in_world = world_from_room.rigid.rotation * Eigen::Vector3d::UnitZ();
  }

  const SemanticTable& table_;
  PriorSceneOptions options_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::vector<Landmark> bodies_;
  std::vector<std::string> body_labels_;
  double table_height_ = 0.0, table_radius_ = 0.0;
  PriorScene scene_;
};

}  // namespace soslam
