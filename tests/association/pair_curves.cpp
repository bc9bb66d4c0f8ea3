// SPDX-License-Identifier: BSD-3-Clause
// What each evidence of a pair of boxes is worth: average precision, and recall at given
// precisions, of "both are of one object", for sequences whose ids are known.
//
//     soslam-pair-curves TABLE SEQUENCE.JSON MATCHES.H5 [SEQUENCE.JSON MATCHES.H5 ...]
//
// prints the rows of a Markdown table, and their means over sequences, after the costs of the true
// groups of boxes and of those that ClusterDetections finds. Pairs are of boxes in
// different frames. Points and colours are those of PairEvidence for the pair alone, without the
// weight that it has among all pairs of a box; colours alone also join. Bodies are those of single
// boxes, and predict the other box of a pair, with its label; the better one of the two counts.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numeric>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/association/association_model.h"
#include "soslam/association/clustering.h"
#include "soslam/association/pair_evidence.h"
#include "soslam/base/parallel.h"
#include "support/association_scenes.h"

namespace soslam {
namespace {

constexpr std::array kEvidence = {"points",          "colours",        "bodies",
                                  "points, colours", "points, bodies", "all"};
constexpr std::array kPrecisions = {0.99, 0.95, 0.9, 0.8};

struct Pair {
  bool are_one;
  std::array<double, kEvidence.size()> log_ratios;
};

// Average precision, then recall at kPrecisions, of pairs in the order of one evidence; of equal
// pairs those of two objects first.
std::array<double, 1 + kPrecisions.size()> Curve(std::vector<Pair> pairs, size_t evidence) {
  std::ranges::sort(pairs, [&](const Pair& a, const Pair& b) {
    return std::pair(-a.log_ratios[evidence], a.are_one) <
           std::pair(-b.log_ratios[evidence], b.are_one);
  });
  const auto all = static_cast<double>(std::ranges::count(pairs, true, &Pair::are_one));
  std::array<double, 1 + kPrecisions.size()> curve = {};
  double found = 0.0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].are_one) continue;
    ++found;
    const double precision = found / static_cast<double>(i + 1);
    curve[0] += precision / all;
    for (size_t k = 0; k < kPrecisions.size(); ++k) {
      if (precision >= kPrecisions[k]) curve[k + 1] = found / all;
    }
  }
  return curve;
}

// Costs of the groups by ids, and of those found, bodies of both fitted alike.
void PrintCosts(const Sequence& given, const ImageMatches& matches, const SemanticTable& table) {
  const Sequence sequence = WithoutIds(given);
  AssociateOptions options;
  options.association = AssociationSource::kEstimated;
  options.shared_points = true;
  const AssociationModel model(sequence, table, options);
  const PairEvidence pairs(sequence, matches);
  std::vector<int> all(sequence.detections.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::vector<int>> found;
  for (const Cluster& cluster : ClusterDetections(model, pairs, all, 0).all) {
    found.push_back(cluster.track.detections);
  }
  std::vector<std::vector<int>> by_ids = DetectionsByObject(given);
  std::erase_if(by_ids, [](const std::vector<int>& boxes) { return boxes.empty(); });
  fmt::print("{}: {} groups by ids cost {:.1f}, {} found cost {:.1f}\n", given.name, by_ids.size(),
             CostOfGroups(model, pairs, by_ids, 0), found.size(),
             CostOfGroups(model, pairs, found, 0));
}

std::vector<Pair> PairsOf(const Sequence& given, const ImageMatches& matches,
                          const SemanticTable& table) {
  Sequence sequence = WithoutIds(given);
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  AssociateOptions options;
  options.association = AssociationSource::kEstimated;
  options.shared_points = true;
  const AssociationModel model(sequence, table, options);
  const PairEvidence evidence(sequence, matches);
  std::vector<Track> bodies(sequence.detections.size());
  ParallelFor(bodies.size(), 0, [&](size_t i) {
    const Detection& detection = sequence.detections[i];
    bodies[i].detections = {static_cast<int>(i)};
    bodies[i].plane_index = model.PlaneOf(detection);
    bodies[i].votes[model.LabelOf(detection)] = detection.score;
    model.FitAsDetected(&bodies[i]);
  });
  const auto by_body = [&](size_t of, size_t other) {
    const Detection& detection = sequence.detections[other];
    const auto prediction = model.Predict(bodies[of], detection.frame_index);
    const auto match = prediction ? model.Match(bodies[of], *prediction, detection) : std::nullopt;
    const double cost = match ? match->cost : model.UnexplainedCost(bodies[of], detection);
    return 0.5 * (model.NewObjectCost(detection) - cost);
  };
  std::vector<std::vector<Pair>> pairs(bodies.size());
  ParallelFor(bodies.size(), 0, [&](size_t i) {
    for (size_t j = 0; j < i; ++j) {
      const Detection &one = sequence.detections[i], &other = sequence.detections[j];
      if (one.frame_index == other.frame_index) continue;
      const int first = static_cast<int>(i), second = static_cast<int>(j);
      const double points = LogRatioOfSharedPoints(evidence.CountPoints(first, second));
      const double product = matches.colours[i].cast<double>().normalized().dot(
          matches.colours[j].cast<double>().normalized());
      const double colours = LogRatioOfColours(product);
      const double body = std::max(by_body(i, j), by_body(j, i));
      pairs[i].push_back(
          {given.detections[i].object_index == given.detections[j].object_index,
           {points, product, body, points + colours, points + body, points + colours + body}});
    }
  });
  std::vector<Pair> all;
  for (const std::vector<Pair>& some : pairs) all.insert(all.end(), some.begin(), some.end());
  return all;
}

int Main(int argc, char** argv) {
  if (argc < 4 || argc % 2 != 0) {
    fmt::print(stderr, "usage: soslam-pair-curves TABLE SEQUENCE.JSON MATCHES.H5 ...\n");
    return 2;
  }
  const SemanticTable table = ReadSemanticTable(argv[1]);
  std::array<std::array<double, 1 + kPrecisions.size()>, kEvidence.size()> means = {};
  const int sequences = (argc - 2) / 2;
  const auto print = [](const std::string& name, size_t evidence, const auto& curve) {
    fmt::print("| {} | {} | {:.3f} |\n", name, kEvidence[evidence], fmt::join(curve, " | "));
  };
  for (int k = 0; k < sequences; ++k) {
    const Sequence sequence = ReadSequence(argv[2 + 2 * k], PlaneNeed::kNotNeeded);
    const ImageMatches matches = ReadMatches(argv[3 + 2 * k]);
    PrintCosts(sequence, matches, table);
    const std::vector<Pair> pairs = PairsOf(sequence, matches, table);
    for (size_t evidence = 0; evidence < kEvidence.size(); ++evidence) {
      const auto curve = Curve(pairs, evidence);
      print(sequence.name, evidence, curve);
      for (size_t i = 0; i < curve.size(); ++i) means[evidence][i] += curve[i] / sequences;
    }
  }
  for (size_t evidence = 0; evidence < kEvidence.size(); ++evidence) {
    print("mean", evidence, means[evidence]);
  }
  return 0;
}

}  // namespace
}  // namespace soslam

int main(int argc, char** argv) { return soslam::Main(argc, argv); }
