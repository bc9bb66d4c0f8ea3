// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/object_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/triangulation.h"
#include "soslam/model/estimates.h"

namespace soslam {
namespace {

constexpr double kCostOfViewBehind = 1e6;

// Linear interpolation of values over the whole circle, the first of which is at the angle 0 (rad).
template <typename Values>
double PeriodicAt(const Values& values, double angle) {
  const auto count = static_cast<int>(values.size());
  const double turns = angle / (2.0 * std::numbers::pi);
  const double place = count * (turns - std::floor(turns));
  const int low = static_cast<int>(place) % count;
  const double part = place - std::floor(place);
  return (1.0 - part) * values[low] + part * values[(low + 1) % count];
}

std::vector<double> PictureWeights(const std::vector<PictureView>& pictures) {
  std::vector<Eigen::Vector3d> rays;
  for (const PictureView& picture : pictures) rays.push_back(picture.ray_in_reference);
  return DirectionWeights(rays,
                          pictures.front().appearance->direction_correlation_deg * kRadPerDeg);
}

// Costs that do not depend on the boxes.
LandmarkCosts PriorCosts(const ObjectEvidence& evidence) {
  LandmarkCosts costs;
  for (auto& term : PriorTerms(evidence)) costs.push_back(std::move(term));
  if (evidence.MayLean()) {
    costs.push_back(std::make_unique<LeaningTerm>(evidence.plane, evidence.standing));
  }
  return costs;
}

std::unique_ptr<const LandmarkTerm> InView(const ObjectEvidence& evidence, const BoxView& view,
                                           std::unique_ptr<const LandmarkTerm> box) {
  return std::make_unique<RobustViewTerm>(std::move(box), view.camera_from_reference,
                                          evidence.huber_delta, view.weight);
}

LandmarkCosts FurtherCosts(const ObjectEvidence& evidence, const Landmark& linearisation) {
  LandmarkCosts costs;
  for (const FurtherEvidence& further : evidence.further) {
    const Landmark in_camera = Transform(further.camera_from_reference, linearisation);
    if (!IsInFront(in_camera)) continue;
    if (auto cost = further.cost_at(in_camera)) {
      costs.push_back(std::make_unique<ViewCost>(std::move(cost), further.camera_from_reference,
                                                 further.weight));
    }
  }
  return costs;
}

LandmarkCosts BoxAndPriorCosts(const ObjectEvidence& evidence, const Landmark& linearisation) {
  LandmarkCosts costs = PriorCosts(evidence);
  for (const BoxView& view : evidence.views) {
    const Landmark in_camera = Transform(view.camera_from_reference, linearisation);
    if (!IsInFront(in_camera)) continue;
    costs.push_back(InView(evidence, view, std::make_unique<BoxTerm>(view.edges, in_camera)));
  }
  return costs;
}

}  // namespace

std::array<BoxEdge, 4> MakeBoxEdges(const Sequence& sequence, const Detection& detection,
                                    const std::optional<ShapePrior>& prior,
                                    const UprightOptions& options) {
  return BoxEdges(sequence.CameraOf(detection), detection.box, detection.is_one_sided,
                  options.detection_sigma_fraction, prior ? prior->edge_bias : EdgeBias());
}

std::vector<PictureView> PicturesInWorld(const Sequence& sequence,
                                         const std::vector<int>& detections) {
  std::vector<PictureView> pictures;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    if (!detection.appearance) continue;
    pictures.push_back(
        {detection.appearance, sequence.FrameOf(detection).world_from_camera.rotation *
                                   sequence.CameraOf(detection).Ray(detection.box.Centre())});
  }
  return pictures;
}

std::optional<ShapePrior> PriorWithPictures(const std::optional<ShapePrior>& prior,
                                            std::vector<PictureView> pictures) {
  std::erase_if(pictures, [](const auto& picture) { return !picture.appearance->log_ratios; });
  if (!prior || !prior->Stands() || pictures.empty()) return prior;
  const std::vector<double> weights = PictureWeights(pictures);
  double views = 0.0;  // effective number
  Eigen::Vector2d information = Eigen::Vector2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < pictures.size(); ++i) {
    const LogRatios& ratios = *pictures[i].appearance->log_ratios;
    const Eigen::Vector2d of_view =
        weights[i] * ratios.sigma.cast<double>().cwiseAbs2().cwiseInverse();
    views += weights[i];
    information += of_view;
    sum += of_view.cwiseProduct(ratios.mean.cast<double>());
  }
  return TimesRatioLikelihood(*prior, sum.cwiseQuotient(information),
                              views * information.cwiseInverse());
}

std::vector<double> PictureCosts(std::vector<PictureView> pictures, const Plane& plane) {
  std::erase_if(pictures, [](const auto& picture) { return !picture.appearance->TellsAzimuth(); });
  if (pictures.empty()) return {};
  const std::vector<double> weights = PictureWeights(pictures);
  const Eigen::Quaterniond reference_from_ground = UprightRotation(plane.normal, 0.0);
  std::vector<double> costs(kYawsOfPictures, 0.0);
  for (size_t i = 0; i < pictures.size(); ++i) {
    const Eigen::Vector3d to_camera =
        -(reference_from_ground.conjugate() * pictures[i].ray_in_reference);
    const double bearing = std::atan2(to_camera.y(), to_camera.x());
    const AzimuthCosts& of_azimuth = pictures[i].appearance->azimuth_costs;
    for (int yaw = 0; yaw < kYawsOfPictures; ++yaw) {
      const double azimuth = bearing - 2.0 * std::numbers::pi * yaw / kYawsOfPictures;
      costs[yaw] += weights[i] * PeriodicAt(of_azimuth, azimuth);
    }
  }
  return costs;
}

std::vector<double> HalfTurnCosts(const std::vector<double>& picture_costs) {
  const size_t half = picture_costs.size() / 2;
  std::vector<double> costs;
  for (size_t i = 0; i < half; ++i) {
    const auto [lower, higher] = std::minmax(picture_costs[i], picture_costs[i + half]);
    costs.push_back(lower - std::log1p(std::exp(lower - higher)));
  }
  const double lowest = costs.empty() ? 0.0 : *std::ranges::min_element(costs);
  for (double& cost : costs) cost -= lowest;
  return costs;
}

double FrontProbability(const std::vector<double>& picture_costs, const Plane& plane,
                        const Landmark& landmark) {
  const double yaw = Yaw(plane.normal, landmark.frame_from_object.rotation);
  return 1.0 / (1.0 + std::exp(PeriodicAt(picture_costs, yaw) -
                               PeriodicAt(picture_costs, yaw + std::numbers::pi)));
}

ObjectEvidence EvidenceInWorld(const Sequence& sequence, const std::vector<int>& detections,
                               const std::optional<ShapePrior>& prior,
                               const UprightOptions& options) {
  const std::vector<PictureView> pictures = PicturesInWorld(sequence, detections);
  ObjectEvidence evidence;
  evidence.prior = PriorWithPictures(prior, pictures);
  evidence.axes_weight = options.axes_weight;
  evidence.huber_delta = options.huber_delta;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    const Object& object = sequence.ObjectOf(detection);
    if (object.plane_index != kNoPlane) {
      const SupportPlane& support = sequence.planes[object.plane_index];
      evidence.plane = support.plane_in_world;
      evidence.scene_axis = support.scene_axis_in_world;
    }
    evidence.views.push_back({MakeBoxEdges(sequence, detection, prior, options),
                              sequence.FrameOf(detection).world_from_camera.Inverse()});
  }
  evidence.picture_costs = PictureCosts(pictures, evidence.plane);
  return evidence;
}

ObjectEvidence EvidenceInCamera(const Sequence& sequence, const Detection& detection,
                                const std::optional<ShapePrior>& prior,
                                const UprightOptions& options) {
  ObjectEvidence evidence;
  evidence.views = {{MakeBoxEdges(sequence, detection, prior, options), Rigid3d()}};
  evidence.plane = detection.plane_in_camera;
  evidence.scene_axis = SceneAxisInCamera(sequence, detection);
  evidence.axes_weight = options.axes_weight;
  evidence.huber_delta = std::numeric_limits<double>::infinity();
  std::vector<PictureView> pictures;
  if (detection.appearance) {
    pictures.push_back(
        {detection.appearance, sequence.CameraOf(detection).Ray(detection.box.Centre())});
  }
  evidence.prior = PriorWithPictures(prior, pictures);
  evidence.picture_costs = PictureCosts(pictures, evidence.plane);
  return evidence;
}

std::string WhyNoSolution(const ObjectEvidence& evidence) {
  const auto measured =
      std::ranges::count(evidence.views.front().edges, false, &BoxEdge::is_one_sided);
  return measured < 3 ? kFewerThanThreeMeasuredEdges : "no_solution";
}

double HeightAtUnitDepth(const BoxView& view) {
  const Eigen::Vector3d height = view.edges[1].plane + view.edges[3].plane;
  return std::abs(height.z() / view.edges[3].plane.y());
}

Eigen::Vector3d NearestToAllRays(const ObjectEvidence& evidence) {
  PointOnPlanes point;
  for (const BoxView& view : evidence.views) {
    // The ray through the centre lies in the planes half-way between opposite edges.
    for (const size_t i : {0, 1}) {
      const Eigen::Vector3d middle = view.edges[i].plane - view.edges[i + 2].plane;
      point.Add({view.camera_from_reference.rotation.conjugate() * middle.normalized(),
                 middle.normalized().dot(view.camera_from_reference.translation)});
    }
  }
  // A weak equation of each view's depth, for rays that are almost parallel: at this depth an
  // object of the prior's height is as high in the image as the box.
  constexpr double kWeight = 1e-4;  // relative to a ray
  for (size_t i = 0; evidence.HasSize() && i < evidence.views.size(); ++i) {
    const auto& [rotation, translation] = evidence.views[i].camera_from_reference;
    const Eigen::Vector3d axis = rotation.conjugate() * Eigen::Vector3d::UnitZ();
    const double depth = evidence.prior->height_m->median / HeightAtUnitDepth(evidence.views[i]);
    point.Add({axis, translation.z() - depth}, kWeight);
  }
  if (!evidence.height_is_free) point.Add(evidence.plane);
  return point.Solve();
}

std::vector<double> DirectionWeights(const std::vector<Eigen::Vector3d>& directions,
                                     double correlation_rad) {
  std::vector<double> similar(directions.size(), 1.0);  // sums over all directions
  if (correlation_rad > 0.0) {
    for (size_t i = 0; i < directions.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const double ratio = AngleBetween(directions[i], directions[j]) / correlation_rad;
        const double similarity = std::exp(-0.5 * ratio * ratio);
        similar[i] += similarity;
        similar[j] += similarity;
      }
    }
  }
  std::vector<double> weights;
  for (const double sum : similar) weights.push_back(1.0 / sum);
  return weights;
}

void WeighViews(double correlation_rad, ObjectEvidence* evidence) {
  const Eigen::Vector3d centre = NearestToAllRays(*evidence);
  std::vector<Eigen::Vector3d> directions;
  for (const BoxView& view : evidence->views) {
    directions.push_back(centre - view.camera_from_reference.Inverse().translation);
  }
  const auto weights = DirectionWeights(directions, correlation_rad);
  for (size_t i = 0; i < weights.size(); ++i) evidence->views[i].weight = weights[i];
}

std::vector<std::unique_ptr<const LandmarkTerm>> PriorTerms(const ObjectEvidence& evidence) {
  std::vector<std::unique_ptr<const LandmarkTerm>> terms;
  if (evidence.HasRatio()) terms.push_back(std::make_unique<RatioTerm>(*evidence.prior));
  if (evidence.HasSize()) {
    terms.push_back(std::make_unique<LengthTerm>(*evidence.prior->Length()));
  }
  if (evidence.scene_axis && evidence.axes_weight > 0.0) {
    terms.push_back(
        std::make_unique<AxisTerm>(evidence.plane, *evidence.scene_axis, evidence.axes_weight));
  }
  if (!evidence.picture_costs.empty() && evidence.Stands()) {
    terms.push_back(
        std::make_unique<YawCostTerm>(evidence.plane, HalfTurnCosts(evidence.picture_costs)));
  }
  if (evidence.yaw_prior) {
    terms.push_back(std::make_unique<YawTerm>(evidence.plane, *evidence.yaw_prior));
  }
  return terms;
}

LandmarkCosts CostsAt(const ObjectEvidence& evidence, const Landmark& linearisation) {
  LandmarkCosts costs = BoxAndPriorCosts(evidence, linearisation);
  for (auto& cost : FurtherCosts(evidence, linearisation)) costs.push_back(std::move(cost));
  return costs;
}

LandmarkCosts OutlineCosts(const ObjectEvidence& evidence) {
  LandmarkCosts costs = PriorCosts(evidence);
  for (const BoxView& view : evidence.views) {
    costs.push_back(InView(evidence, view, std::make_unique<OutlineTerm>(view.edges)));
  }
  return costs;
}

EvidenceCost EvaluateCost(const ObjectEvidence& evidence, const Landmark& landmark, double limit) {
  EvidenceCost cost;
  for (const BoxView& view : evidence.views) {
    const bool is_behind = !IsInFront(Transform(view.camera_from_reference, landmark));
    cost.total += is_behind ? kCostOfViewBehind : 0.0;
  }
  cost.further = TotalCost(FurtherCosts(evidence, landmark), landmark);
  cost.total += TotalCost(BoxAndPriorCosts(evidence, landmark), landmark) + cost.further;
  if (evidence.compared_cost && cost.total < limit) {
    cost.compared = evidence.compared_cost(landmark, limit - cost.total);
    cost.total += cost.compared;
  }
  return cost;
}

std::optional<Eigen::Vector3d> SceneAxisInCamera(const Sequence& sequence,
                                                 const Detection& detection) {
  const auto plane = static_cast<size_t>(sequence.ObjectOf(detection).plane_index);
  const std::optional<Eigen::Vector3d>& axis = sequence.planes[plane].scene_axis_in_world;
  if (!axis) return std::nullopt;
  return sequence.FrameOf(detection).world_from_camera.rotation.conjugate() * *axis;
}

}  // namespace soslam
