// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/input_alternatives.h"

#include <algorithm>
#include <set>

namespace soslam {
namespace {

// Noise alone makes each degree of freedom gain half the over-dispersion of the boxes on average,
// and twice as much once in six times.
constexpr double kPromisingMultiple = 2.0;
constexpr int kMaxIterations = 50;
constexpr size_t kMostPlanesAlone = 10;

// Adds the alternative with these blocks free, if it is promising. Returns whether it is.
bool Add(const std::set<double*>& blocks, const std::vector<int>& planes, BackEndProblem* problem,
         std::vector<InputAlternative>* alternatives) {
  const InputAlternative& given = alternatives->front();
  const double expected = problem->summary().expected_box_cost;
  BackEndVariables& variables = problem->variables();
  const std::vector<double> before = variables.values();
  InputAlternative found;
  for (double* block : blocks) {
    problem->problem().SetParameterBlockVariable(block);
    found.degrees += problem->problem().ParameterBlockTangentSize(block);
  }
  const double gain = problem->Step();
  const double dispersion = std::max(1.0, (given.box_cost - gain) / expected);
  const bool is_promising = 2.0 * gain > kPromisingMultiple * found.degrees * dispersion;
  ceres::Solver::Summary solution;
  if (is_promising) solution = problem->Minimise(kMaxIterations);
  if (is_promising && solution.IsSolutionUsable()) {
    found.cost = solution.final_cost;
    found.box_cost = problem->BoxCost();
    found.focal_factor = variables.FocalFactor();
    for (const int plane : planes) {
      found.planes_in_world[plane] = variables.PlaneValue(static_cast<size_t>(plane));
    }
    alternatives->push_back(found);
  }
  variables.SetValues(before);
  for (double* block : blocks) problem->problem().SetParameterBlockConstant(block);
  return is_promising;
}

}  // namespace

std::vector<InputAlternative> FindInputAlternatives(const Sequence& sequence,
                                                    BackEndProblem* problem) {
  BackEndVariables& variables = problem->variables();
  const auto is_given = [&](const double* block) {
    return problem->problem().HasParameterBlock(block) &&
           problem->problem().IsParameterBlockConstant(block);
  };
  if (!is_given(variables.LogFocal())) return {};  // there are no boxes
  const bool has_views =
      std::ranges::any_of(DetectionsByObject(sequence),
                          [](const std::vector<int>& of_object) { return of_object.size() > 1; });
  if (!has_views) return {};  // the priors alone would tell
  std::vector<int> given_planes;
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    const bool is_estimated = sequence.planes[i].attitude_information.has_value();
    if (!is_estimated && is_given(variables.Offset(i))) given_planes.push_back(static_cast<int>(i));
  }
  std::vector<InputAlternative> alternatives = {
      {.cost = problem->summary().final_cost, .box_cost = problem->summary().box_cost}};
  Add({variables.LogFocal()}, {}, problem, &alternatives);
  const auto add_planes = [&](const std::vector<int>& planes, bool normals) {
    std::set<double*> blocks;
    for (const int plane : planes) {
      blocks.insert(variables.Offset(static_cast<size_t>(plane)));
      if (normals) blocks.insert(variables.Normal(static_cast<size_t>(plane)));
    }
    return Add(blocks, planes, problem, &alternatives);
  };
  for (const bool normals : {false, true}) {
    if (given_planes.empty() || !add_planes(given_planes, normals)) continue;
    if (given_planes.size() == 1 || given_planes.size() > kMostPlanesAlone) continue;
    for (const int plane : given_planes) add_planes({plane}, normals);
  }
  return alternatives;
}

}  // namespace soslam
