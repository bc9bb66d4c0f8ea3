// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/input_alternatives.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;
constexpr size_t kMostPlanesAlone = 10;

// The problem at the present values of its variables.
InputAlternative AlternativeAt(const Sequence& sequence, const std::vector<int>& planes,
                               BackEndProblem* problem) {
  InputAlternative found;
  problem->problem().Evaluate({}, &found.cost, nullptr, nullptr, nullptr);
  found.box_cost = problem->BoxCost();
  found.focal_factor = problem->variables().FocalFactor();
  const auto landmarks = problem->variables().LandmarkValues();
  for (const int index : planes) {
    const Plane& given = sequence.planes[static_cast<size_t>(index)].plane_in_world;
    const Plane plane = problem->variables().PlaneValue(static_cast<size_t>(index));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (size_t i = 0; i < landmarks.size(); ++i) {
      if (!landmarks[i] || sequence.objects[i].plane_index != index) continue;
      sum += landmarks[i]->Centre();
      ++count;
    }
    const Eigen::Vector3d centre = sum / std::max(1, count);
    const Eigen::Vector3d on_given = centre - given.SignedDistance(centre) * given.normal;
    found.planes[index] = {plane, -plane.SignedDistance(on_given),
                           AngleBetween(given.normal, plane.normal)};
  }
  return found;
}

// Adds the alternative with these blocks free, if it is promising. Returns whether it is.
bool Add(const Sequence& sequence, const std::set<double*>& blocks, const std::vector<int>& planes,
         BackEndProblem* problem, std::vector<InputAlternative>* alternatives) {
  // The first step to a far minimum may be half as long as the way.
  constexpr double kPromisingCorrection = 0.5;
  const std::vector<double> before = problem->variables().values();
  int degrees = 0;
  for (double* block : blocks) {
    problem->problem().SetParameterBlockVariable(block);
    degrees += problem->problem().ParameterBlockTangentSize(block);
  }
  const double gain = problem->Step();
  const double dispersion =
      std::max(1.0, (alternatives->front().box_cost - gain) / problem->summary().expected_box_cost);
  // Mean and two standard deviations of chi-square.
  const double twice_by_chance = degrees + 2.0 * std::sqrt(2.0 * degrees);
  // A step that would raise the cost is not taken, and tells nothing of the correction.
  const bool is_refused = problem->variables().values() == before;
  const bool is_promising = 2.0 * gain > twice_by_chance * dispersion &&
                            (is_refused || LargestCorrection(AlternativeAt(
                                               sequence, planes, problem)) > kPromisingCorrection);
  if (is_promising && problem->Minimise(kMaxIterations).IsSolutionUsable()) {
    alternatives->push_back(AlternativeAt(sequence, planes, problem));
    alternatives->back().degrees = degrees;
  }
  problem->variables().SetValues(before);
  for (double* block : blocks) problem->problem().SetParameterBlockConstant(block);
  return is_promising;
}

}  // namespace

double LargestCorrection(const PlaneAlternative& found) {
  return std::max(std::abs(found.height_change_m) / 0.02, found.tilt_rad / kRadPerDeg);
}

double LargestCorrection(const InputAlternative& found) {
  double largest = std::abs(std::log(found.focal_factor)) / 0.02;
  for (const auto& [index, plane] : found.planes) {
    largest = std::max(largest, LargestCorrection(plane));
  }
  return largest;
}

std::vector<InputAlternative> FindInputAlternatives(const BackEndInput& map_input,
                                                    const OptimiseOptions& options,
                                                    const BackEndVariables& solution) {
  const Sequence& sequence = map_input.sequence;
  const bool has_views =
      std::ranges::any_of(DetectionsByObject(sequence),
                          [](const std::vector<int>& of_object) { return of_object.size() > 1; });
  if (!has_views) return {};  // the priors alone would tell
  BackEndInput input{sequence, map_input.initial_landmarks, map_input.priors};
  std::map<std::string, int> objects_of_label;
  for (size_t i = 0; i < input.priors.size(); ++i) {
    if (input.initial_landmarks[i]) ++objects_of_label[sequence.objects[i].label];
  }
  for (size_t i = 0; i < input.priors.size(); ++i) {
    if (!input.priors[i] || !input.initial_landmarks[i]) continue;
    input.priors[i]->log_sigma *= std::sqrt(objects_of_label[sequence.objects[i].label]);
  }
  BackEndProblem problem(input, options);
  BackEndVariables& variables = problem.variables();
  variables.SetValues(solution.values());
  const auto is_given = [&](const double* block) {
    return problem.problem().HasParameterBlock(block) &&
           problem.problem().IsParameterBlockConstant(block);
  };
  if (!is_given(variables.LogFocal())) return {};  // there are no boxes
  std::vector<int> given_planes;
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    const bool is_estimated = sequence.planes[i].attitude_information.has_value();
    if (!is_estimated && is_given(variables.Offset(i))) given_planes.push_back(static_cast<int>(i));
  }
  if (!problem.Minimise(kMaxIterations).IsSolutionUsable()) return {};
  std::vector<InputAlternative> alternatives = {AlternativeAt(sequence, {}, &problem)};
  Add(sequence, {variables.LogFocal()}, {}, &problem, &alternatives);
  const auto add_planes = [&](const std::vector<int>& planes, bool normals) {
    std::set<double*> blocks;
    for (const int plane : planes) {
      blocks.insert(variables.Offset(static_cast<size_t>(plane)));
      if (normals) blocks.insert(variables.Normal(static_cast<size_t>(plane)));
    }
    return Add(sequence, blocks, planes, &problem, &alternatives);
  };
  for (const bool normals : {false, true}) {
    if (given_planes.empty() || !add_planes(given_planes, normals)) continue;
    if (given_planes.size() == 1 || given_planes.size() > kMostPlanesAlone) continue;
    for (const int plane : given_planes) add_planes({plane}, normals);
  }
  return alternatives;
}

}  // namespace soslam
