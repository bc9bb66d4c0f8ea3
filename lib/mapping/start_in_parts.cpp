// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/start_in_parts.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "mapping/minimise.h"

namespace soslam {
namespace {

// It is a start, not the result. But parts that end at a gain of 1e-2 instead cost a whole drive
// 0.06 % more in the end: landmarks that are fitted anew need good poses to find their valleys.
constexpr double kLeastGain = 1e-3;
constexpr int kIterationsPerPart = 6;
constexpr int kIterationsPerLandmark = 10;
// A part is solved again where its last iteration, and landmarks that were fitted anew, have
// lowered its cost by more than this share: every later part starts from where it ends.
constexpr double kUnsettled = 0.02;
constexpr int kMaxRounds = 5;
// So many parts find their minimum together as well.
constexpr size_t kPartsAtOnce = 4;
// Where dead reckoning is lost, a start in parts costs less by orders of magnitude; where it costs
// a little less, parts may only have taken their own views of the same things for different things.
constexpr double kMuchLess = 0.1;

// Frames begin <= i < end, none of another segment.
struct Part {
  size_t begin, end;
  bool begins_segment;
  Terms without_landmark = {};
  std::map<int, Terms> landmarks = {};  // seen from here, by variable: what concerns them
};

std::vector<Part> PartsOf(const std::vector<Frame>& frames, size_t max_frames) {
  std::vector<Part> parts;
  for (size_t first = 0; first < frames.size();) {
    size_t last = first;
    while (last < frames.size() && frames[last].segment == frames[first].segment) ++last;
    const size_t count = (last - first + max_frames - 1) / max_frames;
    for (size_t k = 0; count > kPartsAtOnce && k < count; ++k) {
      parts.push_back(
          {first + k * (last - first) / count, first + (k + 1) * (last - first) / count, k == 0});
    }
    first = last;
  }
  return parts;
}

double TotalCost(const Terms& terms) {
  double cost = 0.0;
  for (const Term* term : terms) cost += term->Cost();
  return cost;
}

class PartByPart {
 public:
  PartByPart(std::vector<Part> parts, const Terms& terms, int threads, BackEndVariables* variables)
      : variables_(*variables), threads_(threads), parts_(std::move(parts)) {
    for (const Variable& variable : variables_.all()) {
      starts_.emplace_back(variable.values, variable.values + NumValues(variable.kind));
    }
    AddTerms(terms);
    ChooseHomes();
  }

  void Run() {
    std::map<int, std::vector<double>> results;  // of landmarks
    for (size_t k = 0; k < parts_.size(); ++k) {
      Solve(parts_[k]);
      for (const auto& [landmark, of_landmark] : parts_[k].landmarks) {
        if (home_.at(landmark) == k) results[landmark] = ValuesOf(landmark);
      }
    }
    for (const auto& [landmark, values] : results) Set(landmark, values);
  }
  void Undo() {
    for (size_t i = 0; i < starts_.size(); ++i) Set(static_cast<int>(i), starts_[i]);
  }

 private:
  Variable& At(int index) { return variables_.all()[static_cast<size_t>(index)]; }
  std::vector<double> ValuesOf(int index) {
    return {At(index).values, At(index).values + NumValues(At(index).kind)};
  }
  void Set(int index, const auto& values) { std::ranges::copy(values, At(index).values); }
  const double* StartOf(int index) const { return starts_[static_cast<size_t>(index)].data(); }

  // To the parts of their last frames, and what concerns a landmark alone to all that see it.
  void AddTerms(const Terms& terms) {
    constexpr size_t kNone = std::numeric_limits<size_t>::max();
    std::vector<size_t> part_of(starts_.size(), kNone);  // by variable
    for (size_t k = 0; k < parts_.size(); ++k) {
      for (size_t i = parts_[k].begin; i < parts_[k].end; ++i) {
        part_of[static_cast<size_t>(variables_.Pose(i))] = k;
      }
    }
    std::map<int, Terms> of_landmark_alone;
    for (const Term* term : terms) {
      int pose = -1, landmark = -1;
      for (const int index : term->variables()) {
        if (At(index).kind == VariableKind::kPose) pose = index;
        if (At(index).kind == VariableKind::kLandmark) landmark = index;
      }
      if (pose >= 0) {
        const size_t k = part_of[static_cast<size_t>(pose)];
        if (k == kNone) continue;
        (landmark >= 0 ? parts_[k].landmarks[landmark] : parts_[k].without_landmark)
            .push_back(term);
      } else if (landmark >= 0) {
        of_landmark_alone[landmark].push_back(term);
      }
    }
    for (Part& part : parts_) {
      for (auto& [landmark, of_landmark] : part.landmarks) {
        const Terms& alone = of_landmark_alone[landmark];
        of_landmark.insert(of_landmark.end(), alone.begin(), alone.end());
      }
    }
  }

  void ChooseHomes() {
    for (size_t k = 0; k < parts_.size(); ++k) {
      for (const auto& [landmark, of_landmark] : parts_[k].landmarks) {
        const auto [home, is_new] = home_.emplace(landmark, k);
        const Terms& of_home = parts_[home->second].landmarks.at(landmark);
        if (of_landmark.size() > of_home.size()) home->second = k;
      }
    }
  }

  std::vector<Variable> AllHeld() const {
    std::vector<Variable> all = variables_.all();
    for (Variable& variable : all) variable.is_held = true;
    return all;
  }
  // Change of a pose since its start (rigid motion in the world frame).
  Rigid3d Correction(int pose) {
    return UnpackPose(At(pose).values) * UnpackPose(StartOf(pose)).Inverse();
  }
  // The middle one of the poses that see a landmark, in the order of its terms, which is that of
  // frames.
  int MiddlePose(const Terms& of_landmark) {
    std::vector<int> poses;
    for (const Term* term : of_landmark) {
      std::ranges::copy_if(term->variables(), std::back_inserter(poses),
                           [&](int index) { return At(index).kind == VariableKind::kPose; });
    }
    return poses[poses.size() / 2];
  }

  void Solve(const Part& part) {
    const Rigid3d carried =
        part.begins_segment ? Rigid3d() : Correction(variables_.Pose(part.begin - 1));
    std::vector<Variable> some = AllHeld();
    const auto release = [&](int index) { some[static_cast<size_t>(index)].is_held = false; };
    Terms terms = part.without_landmark;
    for (size_t i = part.begin; i < part.end; ++i) {
      const int pose = variables_.Pose(i);
      if (At(pose).is_held) continue;
      Set(pose, ToParameterBlock(carried * UnpackPose(StartOf(pose))));
      release(pose);
    }
    for (const auto& [landmark, of_landmark] : part.landmarks) {
      terms.insert(terms.end(), of_landmark.begin(), of_landmark.end());
      if (At(landmark).is_held) continue;
      Set(landmark, ToParameterBlock(Transform(carried, UnpackLandmark(StartOf(landmark)))));
      release(landmark);
    }
    for (int round = 0; round < kMaxRounds; ++round) {
      const std::vector<double> costs =
          Minimise(
              terms,
              {.max_iterations = kIterationsPerPart, .threads = threads_, .least_gain = kLeastGain},
              &some)
              .costs;
      FitLandmarksAnew(part.landmarks);
      if (TotalCost(terms) >= (1.0 - kUnsettled) * costs[costs.size() - 2]) break;
    }
  }

  // While the poses were not right yet, a landmark may have been lost: where it costs less when it
  // starts again from where its frames are now, it does.
  void FitLandmarksAnew(const std::map<int, Terms>& landmarks) {
    std::map<int, std::pair<double, std::vector<double>>> before;
    Terms terms;
    std::vector<Variable> some = AllHeld();
    for (const auto& [landmark, of_landmark] : landmarks) {
      if (At(landmark).is_held) continue;
      terms.insert(terms.end(), of_landmark.begin(), of_landmark.end());
      some[static_cast<size_t>(landmark)].is_held = false;
      before[landmark] = {TotalCost(of_landmark), ValuesOf(landmark)};
      const Rigid3d corrected = Correction(MiddlePose(of_landmark));
      Set(landmark, ToParameterBlock(Transform(corrected, UnpackLandmark(StartOf(landmark)))));
    }
    Minimise(
        terms,
        {.max_iterations = kIterationsPerLandmark, .threads = threads_, .least_gain = kLeastGain},
        &some);
    for (const auto& [landmark, cost_and_values] : before) {
      const auto& [cost, values] = cost_and_values;
      if (!(TotalCost(landmarks.at(landmark)) < cost)) Set(landmark, values);
    }
  }

  BackEndVariables& variables_;
  int threads_;
  std::vector<Part> parts_;
  std::vector<std::vector<double>> starts_;  // by variable
  std::map<int, size_t> home_;               // by landmark, the part that it comes from
};

}  // namespace

bool StartInParts(const Sequence& sequence, const Terms& terms, size_t max_frames_per_part,
                  BackEndVariables* variables, int threads) {
  std::vector<Part> parts = PartsOf(sequence.frames, max_frames_per_part);
  if (parts.empty()) return false;
  size_t frames_in_parts = 0;
  for (const Part& part : parts) frames_in_parts += part.end - part.begin;
  const double before = TotalCost(terms);
  PartByPart in_parts(std::move(parts), terms, threads, variables);
  in_parts.Run();
  if (TotalCost(terms) < kMuchLess * before) return frames_in_parts == sequence.frames.size();
  in_parts.Undo();
  return false;
}

}  // namespace soslam
