// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/decisive_evidence.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "soslam/association/agreement.h"
#include "soslam/base/parallel.h"

namespace soslam {
namespace {

using Evidence = Associations::Evidence;
using PairRow = Associations::PairRow;
using KeptOutRow = Associations::KeptOutRow;

constexpr size_t kRows = 3;  // of each list, for each object

double SumEvidence(const KeptOutRow& row) {
  const Evidence& evidence = row.evidence;
  return evidence.points + evidence.colours + evidence.body + evidence.labels;
}

class EvidenceOfTracks {
 public:
  EvidenceOfTracks(const AssociationModel& model, const PairEvidence& pairs,
                   const Association& association)
      : model_(model), pairs_(pairs), association_(association) {}

  // Adds the pairs of boxes of an object in different frames that hold it least and most.
  void AddPairs(int object, std::vector<PairRow>* least, std::vector<PairRow>* most) const {
    const Track& track = association_.tracks[association_.objects[object]];
    const std::vector<int>& boxes = track.boxes;
    std::vector<Evidence> of_box(boxes.size());
    for (size_t i = 0; i < boxes.size(); ++i) {
      AddBox(track, boxes[i], association_.detections[boxes[i]].match, 1.0, &of_box[i]);
    }
    std::vector<std::tuple<double, double, size_t, size_t>> pairs;  // pictures, the rest, boxes
    for (size_t j = 0; j < boxes.size(); ++j) {
      for (size_t i = 0; i < j; ++i) {
        if (FrameOf(boxes[i]) == FrameOf(boxes[j])) continue;
        const double rest = of_box[i].body + of_box[i].labels + of_box[j].body + of_box[j].labels;
        if (!std::isfinite(rest)) continue;
        pairs.emplace_back(pairs_.LogRatio(boxes[i], boxes[j]), rest, i, j);
      }
    }
    std::ranges::sort(pairs);
    const auto row_of = [&](const auto& pair) {
      const auto [pictures, rest, i, j] = pair;
      PairRow row = {
          object + 1,
          NameOfDetection(model_.sequence(), boxes[i]),
          NameOfDetection(model_.sequence(), boxes[j]),
          {.body = of_box[i].body + of_box[j].body, .labels = of_box[i].labels + of_box[j].labels}};
      AddPictures(boxes[i], boxes[j], &row.evidence);
      return row;
    };
    // No pair is in both lists.
    const size_t count_of_least = std::min(kRows, pairs.size() / 2);
    const size_t count_of_most = std::min(kRows, pairs.size() - count_of_least);
    for (size_t i = 0; i < count_of_least; ++i) least->push_back(row_of(pairs[i]));
    for (size_t i = 1; i <= count_of_most; ++i) most->push_back(row_of(pairs[pairs.size() - i]));
  }

  // The tracks that are nearest to being of an object, nearest first.
  std::vector<KeptOutRow> KeptOut(int object) const {
    constexpr size_t kPredicted = 8;
    const int index = association_.objects[object];
    const Track& track = association_.tracks[index];
    std::set<int> frames;
    for (const int box : track.boxes) frames.insert(FrameOf(box));
    std::map<int, std::optional<Prediction>> predictions;  // by frame
    std::vector<KeptOutRow> rows;
    for (int i = 0; i < std::ssize(association_.tracks); ++i) {
      const Track& other = association_.tracks[i];
      if (i == index || !model_.MayShareSupport(track, other)) continue;
      KeptOutRow row;
      row.object = object + 1;
      row.track = i;
      row.boxes = static_cast<int>(other.boxes.size());
      std::set<int> frames_with_both;
      std::optional<std::pair<double, int>> nearest;  // evidence of pictures, and box
      for (const int box : other.boxes) {
        if (frames.contains(FrameOf(box))) frames_with_both.insert(FrameOf(box));
        Evidence of_box;
        for (const int own : track.boxes) AddPictures(own, box, &of_box);
        row.evidence.points_in_both += of_box.points_in_both;
        row.evidence.points_in_any += of_box.points_in_any;
        row.evidence.points += of_box.points;
        row.evidence.colours += of_box.colours;
        const double of_pictures = of_box.points + of_box.colours;
        if (!nearest || of_pictures > nearest->first) nearest = {of_pictures, box};
      }
      row.nearest = NameOfDetection(model_.sequence(), nearest->second);
      row.frames_with_both = static_cast<int>(frames_with_both.size());
      const std::vector<int> some = SpreadOver(other.boxes, kPredicted);
      for (const int box : some) {
        const auto [at, is_unknown] = predictions.try_emplace(FrameOf(box));
        if (is_unknown) at->second = model_.Predict(track, FrameOf(box));
        AddBox(
            track, box,
            at->second ? model_.Match(track, *at->second, model_.DetectionAt(box)) : std::nullopt,
            1.0 / static_cast<double>(some.size()), &row.evidence);
      }
      if (std::isfinite(row.evidence.labels)) rows.push_back(row);
    }
    std::ranges::stable_sort(rows, std::greater<>(), SumEvidence);
    rows.resize(std::min(rows.size(), kRows));
    return rows;
  }

 private:
  int FrameOf(int detection) const { return model_.DetectionAt(detection).frame_index; }

  void AddPictures(int one, int other, Evidence* evidence) const {
    if (!pairs_.AreLinked(one, other)) return;
    const PairEvidence::Counts counts = pairs_.CountPoints(one, other);
    evidence->points_in_both += counts.in_both;
    evidence->points_in_any += counts.in_any;
    evidence->points += pairs_.LogRatioOfPoints(one, other);
    evidence->colours += pairs_.LogRatioOfColours(one, other);
  }

  // Adds what body and labels of a track say of a box, with this weight. `match`: by its body.
  void AddBox(const Track& track, int box, const std::optional<BoxMatch>& match, double weight,
              Evidence* evidence) const {
    const Detection& detection = model_.DetectionAt(box);
    const double by_label =
        std::log(model_.labels().Probability(model_.LabelOf(detection), track.labels)) +
        0.5 * model_.labels().CostOfAnyLabel();
    const double cost = match ? match->cost : model_.UnexplainedCost(track, detection);
    evidence->labels += weight * by_label;
    evidence->body += weight * (0.5 * (model_.NewObjectCost(detection) - cost) - by_label);
  }

  const AssociationModel& model_;
  const PairEvidence& pairs_;
  const Association& association_;
};

}  // namespace

void AddDecisiveEvidence(const AssociationModel& model, const PairEvidence& pairs, int threads,
                         Association* association) {
  const EvidenceOfTracks evidence(model, pairs, *association);
  const size_t objects = association->objects.size();
  std::vector<std::vector<PairRow>> least(objects), most(objects);
  std::vector<std::vector<KeptOutRow>> kept_out(objects);
  ParallelFor(objects, threads, [&](size_t i) {
    const auto object = static_cast<int>(i);
    evidence.AddPairs(object, &least[i], &most[i]);
    kept_out[i] = evidence.KeptOut(object);
  });
  for (size_t i = 0; i < objects; ++i) {
    std::ranges::copy(least[i], std::back_inserter(association->held_least));
    std::ranges::copy(most[i], std::back_inserter(association->held_most));
    std::ranges::copy(kept_out[i], std::back_inserter(association->kept_out));
  }
  const auto strength = [](const PairRow& row) {
    return std::pair(row.evidence.points + row.evidence.colours,
                     row.evidence.body + row.evidence.labels);
  };
  std::ranges::stable_sort(association->held_least, std::less<>(), strength);
  std::ranges::stable_sort(association->held_most, std::greater<>(), strength);
  std::ranges::stable_sort(association->kept_out, std::greater<>(), SumEvidence);
}

}  // namespace soslam
