// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/input_alternatives.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "soslam/geometry/angles.h"
#include "soslam/mapping/normal_equations.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;
constexpr size_t kMostPlanesAlone = 10;
// The least correction that promises something: the linearised problem may see half of the way to a
// far minimum.
constexpr double kPromisingCorrection = 0.5;

// The focal length and these planes at the present values of the variables.
InputAlternative CompareWithGiven(const Sequence& sequence, const std::vector<int>& planes,
                                  const BackEndVariables& variables) {
  InputAlternative found;
  found.focal_factor = variables.FocalFactor();
  const auto landmarks = variables.LandmarkValues();
  for (const int index : planes) {
    const Plane& given = sequence.planes[static_cast<size_t>(index)].plane_in_world;
    const Plane plane = variables.PlaneValue(static_cast<size_t>(index));
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

// Whether the linearised problem promises more than chance gives, and a correction that matters.
bool IsPromising(const InputAlternative& linearised, double gain, double expected_box_cost) {
  const double dispersion = std::max(1.0, linearised.box_cost / expected_box_cost);
  // Mean and two standard deviations of chi-square.
  const double twice_by_chance = linearised.degrees + 2.0 * std::sqrt(2.0 * linearised.degrees);
  return 2.0 * gain > twice_by_chance * dispersion &&
         LargestCorrection(linearised) > kPromisingCorrection;
}

// The planes whose normals and heights the problem takes as they are given.
std::vector<int> GivenPlanes(const Sequence& sequence, BackEndProblem* problem) {
  std::vector<int> given;
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    if (sequence.planes[i].attitude_information) continue;
    if (!problem->problem().HasParameterBlock(problem->variables().Offset(i))) continue;
    given.push_back(static_cast<int>(i));
  }
  return given;
}

// Priors of the objects of a label that count together as much as that of one.
BackEndInput WithPriorsOfLabels(const BackEndInput& input) {
  BackEndInput result{input.sequence, input.initial_landmarks, input.priors};
  std::map<std::string, int> objects;
  for (size_t i = 0; i < result.priors.size(); ++i) {
    if (result.initial_landmarks[i]) ++objects[input.sequence.objects[i].label];
  }
  for (size_t i = 0; i < result.priors.size(); ++i) {
    if (!result.priors[i] || !result.initial_landmarks[i]) continue;
    result.priors[i]->log_sigma *= std::sqrt(objects[input.sequence.objects[i].label]);
  }
  return result;
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
  const BackEndInput input = WithPriorsOfLabels(map_input);
  BackEndProblem problem(input, options);
  BackEndVariables& variables = problem.variables();
  variables.SetValues(solution.values());
  if (!problem.problem().HasParameterBlock(variables.LogFocal())) return {};  // there are no boxes
  const std::vector<int> given_planes = GivenPlanes(sequence, &problem);
  std::set<double*> given = {variables.LogFocal()};
  for (const int plane : given_planes) {
    given.insert({variables.Normal(static_cast<size_t>(plane)),
                  variables.Offset(static_cast<size_t>(plane))});
  }
  const ScoreTest score(given, &problem.problem());
  const double box_cost = problem.BoxCost();
  std::vector<double> start = variables.values();
  std::vector<InputAlternative> alternatives;
  // Costs are compared in units of what chance gives; a hundredth of one is nothing.
  const double tolerance = 0.01 / problem.summary().expected_box_cost;
  // Adds the problem's minimum from the present values of its variables.
  const auto minimise = [&](const std::vector<int>& free_planes) {
    if (!problem.Minimise(kMaxIterations, tolerance).IsSolutionUsable()) return false;
    alternatives.push_back(CompareWithGiven(sequence, free_planes, variables));
    problem.problem().Evaluate({}, &alternatives.back().cost, nullptr, nullptr, nullptr);
    alternatives.back().box_cost = problem.BoxCost();
    return true;
  };
  // Adds the alternative with these blocks free, if it is promising. Returns whether it is.
  const auto add = [&](const std::set<double*>& blocks, const std::vector<int>& free_planes) {
    const double gain = score.Step(blocks);
    InputAlternative linearised = CompareWithGiven(sequence, free_planes, variables);
    variables.SetValues(start);
    for (double* block : blocks) {
      linearised.degrees += problem.problem().ParameterBlockTangentSize(block);
    }
    linearised.box_cost = box_cost - gain;
    if (!IsPromising(linearised, gain, problem.summary().expected_box_cost)) return false;
    if (alternatives.empty()) {
      if (!minimise({})) return false;
      start = variables.values();
    }
    for (double* block : blocks) problem.problem().SetParameterBlockVariable(block);
    if (minimise(free_planes)) alternatives.back().degrees = linearised.degrees;
    for (double* block : blocks) problem.problem().SetParameterBlockConstant(block);
    variables.SetValues(start);
    return true;
  };
  add({variables.LogFocal()}, {});
  const auto add_planes = [&](const std::vector<int>& planes, bool normals) {
    std::set<double*> blocks;
    for (const int plane : planes) {
      blocks.insert(variables.Offset(static_cast<size_t>(plane)));
      if (normals) blocks.insert(variables.Normal(static_cast<size_t>(plane)));
    }
    return add(blocks, planes);
  };
  for (const bool normals : {false, true}) {
    if (given_planes.empty() || !add_planes(given_planes, normals)) continue;
    if (given_planes.size() == 1 || given_planes.size() > kMostPlanesAlone) continue;
    for (const int plane : given_planes) add_planes({plane}, normals);
  }
  return alternatives;
}

}  // namespace soslam
