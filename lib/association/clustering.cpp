// SPDX-License-Identifier: BSD-3-Clause
#include "association/clustering.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/parallel.h"
#include "geometry/iou.h"
#include "initialisation/object_evidence.h"

namespace soslam {
namespace {

// Costs, -2 log of probabilities: of two boxes of one thing in a frame, the first time and each
// further time, as detectors repeat what they do; of two such boxes that are not alike; of two
// bodies in one place.
constexpr double kSecondBoxCost = 8.0;
constexpr double kFurtherSecondBoxCost = 1.4;
constexpr double kUnlikeBoxCost = 20.0;
constexpr double kOnePlaceCost = 60.0;
// Log odds from which two boxes of neighbouring frames are certainly of one object, and by which
// they are ahead of all rivals.
constexpr double kCertain = 3.0;
// Number of other clusters that a cluster is tried to be joined with.
constexpr size_t kMostPromising = 3;
constexpr double kLeastGain = 1e-6;
constexpr int kMaxRounds = 10;
constexpr double kNone = -std::numeric_limits<double>::infinity();

class Clustering {
 public:
  Clustering(const AssociationModel& model, const SharedPoints& points, int threads)
      : model_(model),
        points_(points),
        threads_(threads),
        single_costs_(model.sequence().detections.size()) {}

  Clusters Run(const std::vector<int>& detections);

 private:
  int FrameOf(int detection) const { return model_.DetectionAt(detection).frame_index; }
  Cluster Evaluate(std::vector<int> detections, const std::vector<const Track*>& parts) const;
  double CostOfBoxes(const Cluster& cluster) const;
  double SharedEvidence(const std::vector<int>& one, const std::vector<int>& other) const;
  double OnePlaceCost(const Cluster& one, const Cluster& other) const;
  double Promise(const Cluster& one, const Cluster& other) const;
  Cluster Joint(const Cluster& one, const Cluster& other) const;
  std::vector<std::vector<size_t>> Tracklets(const std::vector<Cluster>& singles) const;
  void Join();
  bool Divide();
  void Remove(int id);
  void Add(Cluster cluster) { clusters_.emplace(next_id_++, std::move(cluster)); }

  const AssociationModel& model_;
  const SharedPoints& points_;
  int threads_;
  // Cost of each detection's own body, without that of being unseen; none without a body.
  std::vector<std::optional<double>> single_costs_;
  std::map<int, Cluster> clusters_;  // by id
  int next_id_ = 0;
  int first_new_id_ = 0;  // clusters from here on have no promises yet
  // Log odds of one object, by two clusters' ids, above zero; gain of joining them.
  std::map<std::pair<int, int>, double> promises_, gains_;
};

// The cluster of some boxes, with the body that explains them best, if it is like those of the
// parts (any, if there are none).
Cluster Clustering::Evaluate(std::vector<int> detections,
                             const std::vector<const Track*>& parts) const {
  std::ranges::sort(detections, {}, [&](int index) { return std::pair(FrameOf(index), index); });
  Cluster cluster;
  Track& track = cluster.track;
  track.detections = std::move(detections);
  track.plane_index = model_.PlaneOf(model_.DetectionAt(track.detections.front()));
  for (const int index : track.detections) {
    const Detection& detection = model_.DetectionAt(index);
    track.votes[model_.LabelOf(detection)] += detection.score;
  }
  parts.empty() ? model_.FitAsDetected(&track) : model_.FitLike(parts, &track);
  cluster.matches = model_.Explain(track);
  cluster.is_used = BestInFrames(model_, track, cluster.matches);
  cluster.cost = CostOfBoxes(cluster);
  for (size_t i = 0; i < track.detections.size(); ++i) {
    cluster.cost -=
        2.0 * SharedEvidence({track.detections[i]},
                             {track.detections.begin(),
                              track.detections.begin() + static_cast<std::ptrdiff_t>(i)});
  }
  return cluster;
}

double Clustering::CostOfBoxes(const Cluster& cluster) const {
  const Track& track = cluster.track;
  const std::vector<int>& detections = track.detections;
  double as_unseen = 0.0;  // all boxes, each of an object of its own
  double cost = track.prior_cost;
  double first = 0.0;  // by how much it costs more that one of the boxes is of an unseen object
  int firsts = 0;
  int second_boxes = 0;
  // The errors of a shape are the same in neighbouring views, and count once.
  std::vector<Eigen::Vector3d> directions;
  for (const int index : detections) {
    const Frame& frame = model_.sequence().FrameOf(model_.DetectionAt(index));
    const Eigen::Vector3d centre =
        track.fit ? track.fit->landmark_in_world.Centre() : Eigen::Vector3d::Zero();
    directions.push_back(centre - frame.world_from_camera.translation);
  }
  const std::vector<double> weights =
      DirectionWeights(directions, model_.options().upright.ViewCorrelation());
  for (size_t i = 0; i < detections.size(); ++i) {
    const Detection& detection = model_.DetectionAt(detections[i]);
    const double alone = model_.NewObjectCost(detection);
    as_unseen += alone;
    const auto& match = cluster.matches[i];
    if (!match) {
      cost += model_.UnexplainedCost(track, detection);
    } else {
      constexpr double kEdges = 4.0;  // expected squared distance
      const double excess = std::max(0.0, match->distance * match->distance - kEdges);
      cost += match->cost - (1.0 - weights[i]) * excess;
      if (const auto& single = single_costs_[detections[i]]) {
        first += alone - *single;
        ++firsts;
      }
    }
    if (cluster.is_used[i]) continue;
    bool is_beside_used = false;
    for (size_t j = 0; j < detections.size(); ++j) {
      if (cluster.is_used[j] && FrameOf(detections[j]) == FrameOf(detections[i])) {
        is_beside_used = true;
      }
    }
    if (match) {
      ++second_boxes;
    } else if (is_beside_used) {
      cost += kUnlikeBoxCost;
    }
  }
  if (firsts == 0 || detections.size() == 1) return as_unseen;
  if (second_boxes > 0) cost += kSecondBoxCost + (second_boxes - 1) * kFurtherSecondBoxCost;
  return cost + first / firsts;
}

// Sum of what shared points say of pairs of boxes in different frames.
double Clustering::SharedEvidence(const std::vector<int>& one,
                                  const std::vector<int>& other) const {
  double sum = 0.0;
  for (const int a : one) {
    for (const int b : other) {
      if (FrameOf(a) != FrameOf(b)) sum += points_.LogRatio(a, b);
    }
  }
  return sum;
}

// Cost of two bodies that share a part of the smaller one's volume, if their labels may be those of
// one object.
double Clustering::OnePlaceCost(const Cluster& one, const Cluster& other) const {
  const auto is_single = [](const Cluster& cluster) { return cluster.track.detections.size() < 2; };
  if (is_single(one) || is_single(other) || !one.track.fit || !other.track.fit) return 0.0;
  if (!model_.MayBeOneObject(one.track, other.track) &&
      !model_.MayBeOneObject(other.track, one.track)) {
    return 0.0;
  }
  const Landmark& a = one.track.fit->landmark_in_world;
  const Landmark& b = other.track.fit->landmark_in_world;
  const double reach = a.half_axes.norm() + b.half_axes.norm();
  if ((a.Centre() - b.Centre()).norm() > reach) return 0.0;
  const double smaller = 8.0 * std::min(a.half_axes.prod(), b.half_axes.prod());
  const double least = model_.options().same_place_overlap * smaller;
  return IntersectionVolume(a, b) < least ? 0.0 : kOnePlaceCost;
}

// Log odds of one object against two by pairs of boxes alone: points, and how the body of one
// predicts some boxes of the other. kNone where neither tells that they may be one.
double Clustering::Promise(const Cluster& one, const Cluster& other) const {
  constexpr size_t kPredicted = 3;
  if (!model_.MayShareSupport(one.track, other.track)) return kNone;
  const double by_points = SharedEvidence(one.track.detections, other.track.detections);
  const double by_place = 0.5 * OnePlaceCost(one, other);
  double by_boxes = 0.0;
  bool is_predicted = false;
  for (const auto& [by, of] : {std::pair(&one, &other), std::pair(&other, &one)}) {
    const std::vector<int> some = SpreadOver(of->track.detections, kPredicted);
    double sum = 0.0;
    for (const int index : some) {
      const Detection& detection = model_.DetectionAt(index);
      const auto prediction = model_.Predict(by->track, detection.frame_index);
      const auto match =
          prediction ? model_.Match(by->track, *prediction, detection) : std::nullopt;
      if (!match) continue;
      is_predicted = true;
      sum += 0.5 * (model_.NewObjectCost(detection) - match->cost);
    }
    by_boxes = std::max(by_boxes, sum / static_cast<double>(some.size()));
  }
  const bool may_be_one = is_predicted || by_points > 0.0 || by_place > 0.0;
  return may_be_one ? by_points + by_boxes + by_place : kNone;
}

// Both as one cluster: fitted from their landmarks, and anew where points say that they are one
// object and some box is not explained.
Cluster Clustering::Joint(const Cluster& one, const Cluster& other) const {
  std::vector<int> both = one.track.detections;
  both.insert(both.end(), other.track.detections.begin(), other.track.detections.end());
  Cluster joint = Evaluate(both, {&one.track, &other.track});
  if (std::ranges::all_of(joint.matches, &std::optional<BoxMatch>::has_value) ||
      SharedEvidence(one.track.detections, other.track.detections) <= 0.0) {
    return joint;
  }
  Cluster anew = Evaluate(std::move(both), {});
  return anew.cost < joint.cost ? anew : joint;
}

// Single boxes of neighbouring frames that are certainly of one object, as indices.
std::vector<std::vector<size_t>> Clustering::Tracklets(const std::vector<Cluster>& singles) const {
  std::vector<std::vector<size_t>> in_frame(model_.sequence().frames.size());
  for (size_t i = 0; i < singles.size(); ++i) {
    in_frame[FrameOf(singles[i].track.detections.front())].push_back(i);
  }
  std::vector<std::optional<size_t>> next(singles.size());
  std::vector<char> has_previous(singles.size(), 0);
  ParallelFor(in_frame.size() - 1, threads_, [&](size_t frame) {
    const std::vector<size_t>&from = in_frame[frame], &to = in_frame[frame + 1];
    if (from.empty() || to.empty()) return;
    Eigen::MatrixXd odds(from.size(), to.size());
    for (Eigen::Index i = 0; i < odds.rows(); ++i) {
      for (Eigen::Index j = 0; j < odds.cols(); ++j) {
        odds(i, j) = Promise(singles[from[i]], singles[to[j]]);
      }
    }
    for (Eigen::Index i = 0; i < odds.rows(); ++i) {
      Eigen::Index j = 0;
      const double best = odds.row(i).maxCoeff(&j);
      // Both counts have the box itself.
      const auto rivals = (odds.row(i).array() > best - kCertain).count() +
                          (odds.col(j).array() > best - kCertain).count() - 2;
      if (best < kCertain || rivals > 0) continue;
      next[from[i]] = to[j];
      has_previous[to[j]] = 1;
    }
  });
  std::vector<std::vector<size_t>> tracklets;
  for (size_t i = 0; i < singles.size(); ++i) {
    if (has_previous[i] != 0) continue;
    std::vector<size_t>& tracklet = tracklets.emplace_back();
    for (std::optional<size_t> j = i; j; j = next[*j]) tracklet.push_back(*j);
  }
  return tracklets;
}

// Joins clusters that each gain most by each other, until nothing is gained. Those are tried that
// are most promising for one of the two.
void Clustering::Join() {
  while (true) {
    std::vector<std::vector<std::pair<std::pair<int, int>, double>>> found(
        static_cast<size_t>(next_id_ - first_new_id_));
    ParallelFor(found.size(), threads_, [&](size_t i) {
      const auto fresh = clusters_.find(first_new_id_ + static_cast<int>(i));
      if (fresh == clusters_.end()) return;
      for (auto other = clusters_.begin(); other != fresh; ++other) {
        const double promise = Promise(other->second, fresh->second);
        if (promise > 0.0) found[i].push_back({{other->first, fresh->first}, promise});
      }
    });
    for (const auto& pairs : found) promises_.insert(pairs.begin(), pairs.end());
    first_new_id_ = next_id_;
    std::map<int, std::vector<std::pair<double, int>>> partners;
    for (const auto& [pair, promise] : promises_) {
      partners[pair.first].emplace_back(-promise, pair.second);
      partners[pair.second].emplace_back(-promise, pair.first);
    }
    std::set<std::pair<int, int>> tried;
    for (auto& [one, others] : partners) {
      std::ranges::sort(others);
      if (others.size() > kMostPromising) others.resize(kMostPromising);
      for (const auto& [promise, other] : others) tried.insert(std::minmax(one, other));
    }

    std::vector<std::pair<int, int>> unknown;
    std::ranges::copy_if(tried, std::back_inserter(unknown),
                         [&](const auto& pair) { return !gains_.contains(pair); });
    std::vector<double> gains(unknown.size());
    ParallelFor("pairs", unknown.size(), threads_, [&](size_t i) {
      const Cluster &one = clusters_.at(unknown[i].first), &other = clusters_.at(unknown[i].second);
      gains[i] = one.cost + other.cost + OnePlaceCost(one, other) - Joint(one, other).cost;
    });
    for (size_t i = 0; i < unknown.size(); ++i) gains_[unknown[i]] = gains[i];
    std::map<int, std::pair<double, int>> best;  // gain and partner of each cluster
    for (const auto& pair : tried) {
      const double gain = gains_.at(pair);
      if (gain < kLeastGain) continue;
      for (const auto& [one, other] : {pair, std::pair(pair.second, pair.first)}) {
        const auto [at, is_first] = best.emplace(one, std::pair(gain, other));
        if (!is_first && gain > at->second.first) at->second = {gain, other};
      }
    }

    std::vector<std::pair<int, int>> joined;
    for (const auto& [one, partner] : best) {
      if (one < partner.second && best.at(partner.second).second == one) {
        joined.emplace_back(one, partner.second);
      }
    }
    if (joined.empty()) return;
    std::vector<Cluster> joint(joined.size());
    ParallelFor(joined.size(), threads_, [&](size_t i) {
      joint[i] = Joint(clusters_.at(joined[i].first), clusters_.at(joined[i].second));
    });
    for (size_t i = 0; i < joined.size(); ++i) {
      Remove(joined[i].first);
      Remove(joined[i].second);
      Add(std::move(joint[i]));
    }
  }
}

void Clustering::Remove(int id) {
  clusters_.erase(id);
  const auto is_of = [id](const auto& row) {
    return row.first.first == id || row.first.second == id;
  };
  std::erase_if(promises_, is_of);
  std::erase_if(gains_, is_of);
}

// Takes out of each cluster the part that lowers the cost most: a box that its body does not
// explain, to be on its own or of another cluster; all of these; or the half that points hold
// least. True if there was any.
bool Clustering::Divide() {
  bool has_divided = false;
  std::vector<int> ids;
  for (const auto& [id, cluster] : clusters_) ids.push_back(id);
  for (const int id : ids) {
    const auto at = clusters_.find(id);
    if (at == clusters_.end()) continue;
    const Cluster& cluster = at->second;
    const std::vector<int>& detections = cluster.track.detections;
    std::vector<std::vector<int>> parts;
    std::vector<int> unexplained;
    for (size_t i = 0; i < detections.size(); ++i) {
      if (!cluster.matches[i]) unexplained.push_back(detections[i]);
    }
    if (detections.size() > 1) {
      for (const int index : unexplained) parts.push_back({index});
    }
    if (unexplained.size() > 1) parts.push_back(unexplained);
    std::optional<double> weakest;
    std::vector<int> half;
    for (size_t i = 2; i + 1 < detections.size(); ++i) {
      const auto middle = detections.begin() + static_cast<std::ptrdiff_t>(i);
      const double held = SharedEvidence({detections.begin(), middle}, {middle, detections.end()});
      if (weakest && held >= *weakest) continue;
      weakest = held;
      half = {detections.begin(), middle};
    }
    if (weakest) parts.push_back(half);

    struct Move {
      double gain = 0.0;
      std::optional<int> to;  // id of the cluster that takes the part in
    };
    std::vector<Move> moves(parts.size());
    const auto without = [&](const std::vector<int>& part) {
      std::vector<int> rest;
      std::ranges::copy_if(detections, std::back_inserter(rest),
                           [&](int index) { return std::ranges::find(part, index) == part.end(); });
      return rest;
    };
    ParallelFor(parts.size(), threads_, [&](size_t i) {
      const std::vector<int> left = without(parts[i]);
      if (left.empty()) return;
      const Cluster rest = Evaluate(left, {&cluster.track});
      const Cluster part = Evaluate(parts[i], {});
      const double gain = cluster.cost - rest.cost;
      moves[i].gain = gain - part.cost - OnePlaceCost(rest, part);
      if (parts[i].size() > 1) return;
      for (const auto& [other, into] : clusters_) {
        if (other == id || into.track.detections.size() < 2 || Promise(into, part) <= 0.0) continue;
        std::vector<int> both = into.track.detections;
        both.push_back(parts[i].front());
        const double gain_there = gain + into.cost - Evaluate(both, {&into.track}).cost;
        if (gain_there > moves[i].gain) moves[i] = {gain_there, other};
      }
    });
    const auto best = std::ranges::max_element(moves, {}, &Move::gain);
    if (best == moves.end() || best->gain < kLeastGain) continue;
    std::vector<int> part = parts[static_cast<size_t>(best - moves.begin())];
    const std::vector<int> rest = without(part);
    if (best->to) {
      const std::vector<int>& more = clusters_.at(*best->to).track.detections;
      part.insert(part.end(), more.begin(), more.end());
      Remove(*best->to);
    }
    Remove(id);
    Add(Evaluate(rest, {}));
    Add(Evaluate(part, {}));
    has_divided = true;
  }
  return has_divided;
}

Clusters Clustering::Run(const std::vector<int>& detections) {
  std::vector<Cluster> singles(detections.size());
  ParallelFor("boxes", singles.size(), threads_,
              [&](size_t i) { singles[i] = Evaluate({detections[i]}, {}); });
  for (size_t i = 0; i < singles.size(); ++i) {
    const auto& match = singles[i].matches.front();
    if (match) single_costs_[detections[i]] = singles[i].track.prior_cost + match->cost;
  }
  const auto tracklets = Tracklets(singles);
  std::vector<Cluster> clusters(tracklets.size());
  ParallelFor("tracklets", tracklets.size(), threads_, [&](size_t i) {
    std::vector<int> boxes;
    std::vector<const Track*> parts;
    for (const size_t single : tracklets[i]) {
      boxes.push_back(detections[single]);
      parts.push_back(&singles[single].track);
    }
    clusters[i] = parts.size() == 1 ? singles[tracklets[i].front()] : Evaluate(boxes, parts);
  });
  for (Cluster& cluster : clusters) Add(std::move(cluster));
  Clusters result{{}, false};
  for (int round = 0; round < kMaxRounds && !result.is_settled; ++round) {
    Join();
    result.is_settled = !Divide();
  }
  for (auto& [id, cluster] : clusters_) result.all.push_back(std::move(cluster));
  return result;
}

}  // namespace

std::vector<bool> BestInFrames(const AssociationModel& model, const Track& track,
                               const std::vector<std::optional<BoxMatch>>& matches) {
  std::map<int, size_t> best;  // by frame
  for (size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i]) continue;
    const int frame = model.DetectionAt(track.detections[i]).frame_index;
    const auto [at, is_first] = best.emplace(frame, i);
    if (!is_first && matches[i]->cost < matches[at->second]->cost) at->second = i;
  }
  std::vector<bool> is_best(matches.size(), false);
  for (const auto& [frame, i] : best) is_best[i] = true;
  return is_best;
}

Clusters ClusterDetections(const AssociationModel& model, const SharedPoints& points,
                           const std::vector<int>& detections, int threads) {
  return Clustering(model, points, threads).Run(detections);
}

}  // namespace soslam
