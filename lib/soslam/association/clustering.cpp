// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/clustering.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "soslam/base/parallel.h"
#include "soslam/geometry/iou.h"
#include "soslam/initialisation/object_evidence.h"

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
// Number of others with which joins of a cluster are tried, once joins with one gain nothing more.
constexpr size_t kMostPromising = 3;
// Number of frames within which boxes are grouped first, then within twice as many, and so on.
constexpr int kBlockFrames = 128;
constexpr double kLeastGain = 1e-6;
constexpr int kMaxRounds = 10;
constexpr double kNone = -std::numeric_limits<double>::infinity();

// A cluster, and with which others it has been compared.
struct Group : Cluster {
  int block = 0;        // it is compared with all others in its block of this number of frames
  int tried_until = 0;  // divisions into clusters with ids below are tried
};

// Two groups as one.
struct Trial {
  Cluster joint;
  double gain = 0.0;
};

struct Clustering {
  int FrameOf(int detection) const { return model.DetectionAt(detection).frame_index; }

  const AssociationModel& model;
  const PairEvidence& pairs;
  int threads;
  std::vector<Cluster> singles = {};  // by detection
  std::map<int, Group> groups = {};   // by id
  int next_id = 0;
  // Log odds of one object, by two groups' ids, above zero; what joining them would lead to.
  std::map<std::pair<int, int>, double> promises = {};
  std::map<std::pair<int, int>, Trial> trials = {};
};

double CostOfBoxes(const Clustering& all, const Cluster& cluster) {
  const AssociationModel& model = all.model;
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
    const Frame& frame = model.sequence().FrameOf(model.DetectionAt(index));
    const Eigen::Vector3d centre =
        track.fit ? track.fit->landmark_in_world.Centre() : Eigen::Vector3d::Zero();
    directions.push_back(centre - frame.world_from_camera.translation);
  }
  const std::vector<double> weights =
      DirectionWeights(directions, model.options().upright.ViewCorrelation());
  std::set<int> frames_of_used;
  for (size_t i = 0; i < detections.size(); ++i) {
    if (cluster.is_used[i]) frames_of_used.insert(all.FrameOf(detections[i]));
  }
  for (size_t i = 0; i < detections.size(); ++i) {
    const Detection& detection = model.DetectionAt(detections[i]);
    const double alone = model.NewObjectCost(detection);
    as_unseen += alone;
    const auto& match = cluster.matches[i];
    if (!match) {
      cost += model.UnexplainedCost(track, detection);
    } else {
      constexpr double kEdges = 4.0;  // expected squared distance
      const double excess = std::max(0.0, match->distance * match->distance - kEdges);
      cost += match->cost - (1.0 - weights[i]) * excess;
      const Cluster& single = all.singles[detections[i]];
      if (!single.matches.empty() && single.matches.front()) {
        first += alone - single.track.prior_cost - single.matches.front()->cost;
        ++firsts;
      }
    }
    if (cluster.is_used[i]) continue;
    if (match) {
      ++second_boxes;
    } else if (frames_of_used.contains(detection.frame_index)) {
      cost += kUnlikeBoxCost;
    }
  }
  if (firsts == 0 || detections.size() == 1) return as_unseen;
  if (second_boxes > 0) cost += kSecondBoxCost + (second_boxes - 1) * kFurtherSecondBoxCost;
  return cost + first / firsts;
}

// The cluster of some boxes, with the body that explains them best, if it is like those of the
// parts (any, if there are none). `log_ratio` is what pictures say of all pairs.
Cluster Evaluate(const Clustering& all, std::vector<int> detections, double log_ratio,
                 const std::vector<const Track*>& parts) {
  const AssociationModel& model = all.model;
  std::ranges::sort(detections, {},
                    [&](int index) { return std::pair(all.FrameOf(index), index); });
  Cluster cluster;
  Track& track = cluster.track;
  track.detections = std::move(detections);
  track.plane_index = model.PlaneOf(model.DetectionAt(track.detections.front()));
  for (const int index : track.detections) {
    const Detection& detection = model.DetectionAt(index);
    track.votes[model.LabelOf(detection)] += detection.score;
  }
  parts.empty() ? model.FitAsDetected(&track) : model.FitLike(parts, &track);
  cluster.matches = model.Explain(track);
  cluster.is_used = BestInFrames(model, track, cluster.matches);
  cluster.log_ratio = log_ratio;
  cluster.cost = CostOfBoxes(all, cluster) - 2.0 * log_ratio;
  return cluster;
}

// Cost of two bodies that share a part of the smaller one's volume, if their labels may be those of
// one object.
double OnePlaceCost(const AssociationModel& model, const Cluster& one, const Cluster& other) {
  const auto is_single = [](const Cluster& cluster) { return cluster.track.detections.size() < 2; };
  if (is_single(one) || is_single(other) || !one.track.fit || !other.track.fit) return 0.0;
  const Landmark& a = one.track.fit->landmark_in_world;
  const Landmark& b = other.track.fit->landmark_in_world;
  const double reach = a.half_axes.norm() + b.half_axes.norm();
  if ((a.Centre() - b.Centre()).norm() > reach) return 0.0;
  if (!model.MayBeOneObject(one.track, other.track) &&
      !model.MayBeOneObject(other.track, one.track)) {
    return 0.0;
  }
  const double smaller = 8.0 * std::min(a.half_axes.prod(), b.half_axes.prod());
  const double least = model.options().same_place_overlap * smaller;
  return IntersectionVolume(a, b) < least ? 0.0 : kOnePlaceCost;
}

// The boxes of a track that others' bodies are to predict.
std::vector<int> BoxesToPredict(const Track& track) {
  constexpr size_t kPredicted = 3;
  return SpreadOver(track.detections, kPredicted);
}

// Log odds that a box is of a track's body, not of an unseen one; zero where the body does not
// predict it, otherwise above.
double OddsOfBox(const AssociationModel& model, const Track& body,
                 const std::optional<Prediction>& prediction, int box) {
  const Detection& detection = model.DetectionAt(box);
  const auto match = prediction ? model.Match(body, *prediction, detection) : std::nullopt;
  return match ? 0.5 * (model.NewObjectCost(detection) - match->cost) : 0.0;
}

// Mean OddsOfBox of some boxes. `predict`: the body's Prediction in a frame, if any.
template <typename Predict>
double OddsOfBoxes(const AssociationModel& model, const Track& body, const std::vector<int>& boxes,
                   const Predict& predict) {
  double sum = 0.0;
  for (const int box : boxes) {
    sum += OddsOfBox(model, body, predict(model.DetectionAt(box).frame_index), box);
  }
  return sum / static_cast<double>(boxes.size());
}

// Log odds of one object against two that may share a support, by pairs of boxes alone: pictures,
// and the larger of OddsOfBoxes by either body. kNone where neither tells that they may be one.
double Promise(const Clustering& all, const Cluster& one, const Cluster& other, double by_boxes) {
  const double by_pictures = all.pairs.LogRatio(one.track.detections, other.track.detections);
  const double by_place = 0.5 * OnePlaceCost(all.model, one, other);
  const bool may_be_one = by_boxes > 0.0 || by_pictures > 0.0 || by_place > 0.0;
  return may_be_one ? by_pictures + by_boxes + by_place : kNone;
}

// Single boxes of neighbouring frames that are certainly of one object.
std::vector<std::vector<int>> Tracklets(const Clustering& all, const std::vector<int>& detections) {
  std::vector<std::vector<int>> in_frame(all.model.sequence().frames.size());
  if (in_frame.empty()) return {};
  for (const int detection : detections) in_frame[all.FrameOf(detection)].push_back(detection);
  std::vector<std::optional<int>> next(all.singles.size());
  std::vector<char> has_previous(all.singles.size(), 0);
  ParallelFor(in_frame.size() - 1, all.threads, [&](size_t frame) {
    const std::vector<int>&from = in_frame[frame], &to = in_frame[frame + 1];
    if (from.empty() || to.empty()) return;
    const auto predictions = [&](const std::vector<int>& boxes, size_t other_frame) {
      std::vector<std::optional<Prediction>> by_box;
      for (const int box : boxes) {
        by_box.push_back(all.model.Predict(all.singles[box].track, static_cast<int>(other_frame)));
      }
      return by_box;
    };
    const auto forwards = predictions(from, frame + 1), backwards = predictions(to, frame);
    Eigen::MatrixXd odds(from.size(), to.size());
    for (Eigen::Index i = 0; i < odds.rows(); ++i) {
      for (Eigen::Index j = 0; j < odds.cols(); ++j) {
        const Cluster &one = all.singles[from[i]], &other = all.singles[to[j]];
        const double by_boxes = std::max(OddsOfBox(all.model, one.track, forwards[i], to[j]),
                                         OddsOfBox(all.model, other.track, backwards[j], from[i]));
        odds(i, j) = all.model.MayShareSupport(one.track, other.track)
                         ? Promise(all, one, other, by_boxes)
                         : kNone;
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
  std::vector<std::vector<int>> tracklets;
  for (const int detection : detections) {
    if (has_previous[detection] != 0) continue;
    std::vector<int>& tracklet = tracklets.emplace_back();
    for (std::optional<int> at = detection; at; at = next[*at]) tracklet.push_back(*at);
  }
  return tracklets;
}

void Add(Cluster cluster, Clustering* all) {
  all->groups.emplace(all->next_id++, Group{std::move(cluster)});
}

void Remove(const std::set<int>& ids, Clustering* all) {
  for (const int id : ids) all->groups.erase(id);
  const auto is_of = [&ids](const auto& row) {
    return ids.contains(row.first.first) || ids.contains(row.first.second);
  };
  std::erase_if(all->promises, is_of);
  std::erase_if(all->trials, is_of);
}

// Block of frames, of this number, that a cluster is in.
int FindBlock(const Clustering& all, const Cluster& cluster, int frames) {
  return all.FrameOf(cluster.track.detections.front()) / frames;
}

// Adds the promises of pairs in one block that have none yet.
void ComparePairs(int block, Clustering* all) {
  const AssociationModel& model = all->model;
  std::vector<std::map<int, Group>::iterator> groups;
  std::vector<std::vector<int>> boxes;  // of each group, to predict
  for (auto at = all->groups.begin(); at != all->groups.end(); ++at) {
    groups.push_back(at);
    boxes.push_back(BoxesToPredict(at->second.track));
  }
  const auto is_new = [&](const Group& one, const Group& other) {
    const int known = std::min(one.block, other.block);
    return FindBlock(*all, one, block) == FindBlock(*all, other, block) &&
           (known == 0 || FindBlock(*all, one, known) != FindBlock(*all, other, known)) &&
           model.MayShareSupport(one.track, other.track);
  };
  // OddsOfBoxes above zero by the body of each group, by the place of the group of the boxes.
  std::vector<std::map<size_t, double>> by_body(groups.size());
  ParallelFor(groups.size(), all->threads, [&](size_t i) {
    const Group& one = groups[i]->second;
    std::map<int, std::optional<Prediction>> predictions;  // by frame
    const auto predict = [&](int frame) -> const auto& {
      const auto [at, is_unknown] = predictions.try_emplace(frame);
      if (is_unknown) at->second = model.Predict(one.track, frame);
      return at->second;
    };
    for (size_t j = 0; j < groups.size(); ++j) {
      if (j == i || !is_new(one, groups[j]->second)) continue;
      const double odds = OddsOfBoxes(model, one.track, boxes[j], predict);
      if (odds > 0.0) by_body[i].emplace(j, odds);
    }
  });
  std::vector<std::vector<std::pair<std::pair<int, int>, double>>> found(groups.size());
  ParallelFor(groups.size(), all->threads, [&](size_t i) {
    const Group& one = groups[i]->second;
    const auto odds = [&](size_t body, size_t of_boxes) {
      const auto at = by_body[body].find(of_boxes);
      return at == by_body[body].end() ? 0.0 : at->second;
    };
    for (size_t j = i + 1; j < groups.size(); ++j) {
      const Group& other = groups[j]->second;
      if (!is_new(one, other)) continue;
      const double promise = Promise(*all, one, other, std::max(odds(i, j), odds(j, i)));
      if (promise > 0.0) found[i].push_back({{groups[i]->first, groups[j]->first}, promise});
    }
  });
  for (const auto& pairs : found) all->promises.insert(pairs.begin(), pairs.end());
  for (auto& [id, group] : all->groups) group.block = block;
}

// Joins clusters in one block that each gain most by each other, until nothing is gained. Pairs are
// tried that are among the `partners_each` most promising ones for one of the two.
void MergeClusters(int block, size_t partners_each, Clustering* all) {
  while (true) {
    ComparePairs(block, all);
    std::map<int, std::vector<std::pair<double, int>>> partners;
    for (const auto& [pair, promise] : all->promises) {
      partners[pair.first].emplace_back(-promise, pair.second);
      partners[pair.second].emplace_back(-promise, pair.first);
    }
    std::set<std::pair<int, int>> tried;
    for (auto& [one, others] : partners) {
      std::ranges::sort(others);
      if (others.size() > partners_each) others.resize(partners_each);
      for (const auto& [promise, other] : others) tried.insert(std::minmax(one, other));
    }
    std::vector<std::pair<int, int>> unknown;
    std::ranges::copy_if(tried, std::back_inserter(unknown),
                         [&](const auto& pair) { return !all->trials.contains(pair); });
    std::vector<Trial> trials(unknown.size());
    ParallelFor("pairs", unknown.size(), all->threads, [&](size_t i) {
      const Cluster& one = all->groups.at(unknown[i].first);
      const Cluster& other = all->groups.at(unknown[i].second);
      std::vector<int> both = one.track.detections;
      both.insert(both.end(), other.track.detections.begin(), other.track.detections.end());
      const double between = all->pairs.LogRatio(one.track.detections, other.track.detections);
      const double log_ratio = one.log_ratio + other.log_ratio + between;
      Cluster joint = Evaluate(*all, both, log_ratio, {&one.track, &other.track});
      // Fitted anew where pictures say that both are one object and some box is not explained.
      const auto is_explained = &std::optional<BoxMatch>::has_value;
      if (between > 0.0 && !std::ranges::all_of(joint.matches, is_explained)) {
        Cluster anew = Evaluate(*all, std::move(both), log_ratio, {});
        if (anew.cost < joint.cost) joint = std::move(anew);
      }
      trials[i].gain = one.cost + other.cost + OnePlaceCost(all->model, one, other) - joint.cost;
      if (trials[i].gain < kLeastGain) return;
      trials[i].joint = std::move(joint);
    });
    for (size_t i = 0; i < unknown.size(); ++i) all->trials[unknown[i]] = std::move(trials[i]);
    std::map<int, std::pair<double, int>> best;  // gain and partner of each cluster
    for (const auto& pair : tried) {
      const double gain = all->trials.at(pair).gain;
      if (gain < kLeastGain) continue;
      for (const auto& [one, other] : {pair, std::pair(pair.second, pair.first)}) {
        const auto [at, is_first] = best.emplace(one, std::pair(gain, other));
        if (!is_first && gain > at->second.first) at->second = {gain, other};
      }
    }
    std::vector<Cluster> joined;
    std::set<int> parts;
    for (const auto& [one, partner] : best) {
      const int other = partner.second;
      if (one > other || best.at(other).second != one) continue;
      joined.push_back(std::move(all->trials.at({one, other}).joint));
      parts.insert({one, other});
    }
    if (joined.empty()) return;
    Remove(parts, all);
    for (Cluster& joint : joined) Add(std::move(joint), all);
  }
}

// The parts of a cluster that may be of another object: a box that its body does not explain; all
// of these; the half in time that pictures hold least.
std::vector<std::vector<int>> FindParts(const Clustering& all, const Cluster& cluster) {
  const std::vector<int>& detections = cluster.track.detections;
  std::vector<std::vector<int>> parts;
  std::vector<int> unexplained;
  for (size_t i = 0; i < detections.size(); ++i) {
    if (!cluster.matches[i]) unexplained.push_back(detections[i]);
  }
  if (detections.size() > 1) {
    for (const int index : unexplained) parts.push_back({index});
  }
  if (unexplained.size() > 1 && unexplained.size() < detections.size()) {
    parts.push_back(unexplained);
  }
  std::optional<double> weakest;
  double held = 0.0;  // log ratio between the first i boxes and the others
  size_t size = 0;
  for (size_t i = 1; i + 1 < detections.size(); ++i) {
    const auto middle = detections.begin() + static_cast<std::ptrdiff_t>(i);
    const int moved = detections[i - 1];
    held += all.pairs.LogRatio({moved}, {middle, detections.end()}) -
            all.pairs.LogRatio({moved}, {detections.begin(), middle - 1});
    if (i < 2 || (weakest && held >= *weakest)) continue;
    weakest = held;
    size = i;
  }
  if (weakest) {
    parts.emplace_back(detections.begin(), detections.begin() + static_cast<std::ptrdiff_t>(size));
  }
  return parts;
}

// A cluster without a part, which is on its own or in another cluster.
struct Division {
  double gain = 0.0;
  Cluster rest;
  Cluster part;  // with the cluster that takes it in
  std::optional<int> to;
};

// The division that lowers the cost most; none if there is no such.
Division BestDivision(int block, int id, const Clustering& all) {
  const Group& cluster = all.groups.at(id);
  const std::vector<std::vector<int>> parts = FindParts(all, cluster);
  std::vector<Division> divisions(parts.size());
  ParallelFor(parts.size(), all.threads, [&](size_t i) {
    std::vector<int> others;
    std::ranges::copy_if(cluster.track.detections, std::back_inserter(others), [&](int index) {
      return std::ranges::find(parts[i], index) == parts[i].end();
    });
    double own = 0.0;
    for (const int index : parts[i]) own += 0.5 * all.pairs.LogRatio({index}, parts[i]);
    const double between = all.pairs.LogRatio(parts[i], others);
    const Cluster rest = Evaluate(all, others, cluster.log_ratio - own - between, {&cluster.track});
    const bool is_single = parts[i].size() == 1;
    Division& best = divisions[i];
    const Cluster part =
        is_single ? all.singles[parts[i].front()] : Evaluate(all, parts[i], own, {});
    const double gain = cluster.cost - rest.cost;
    best = {gain - part.cost - OnePlaceCost(all.model, rest, part), rest, part, {}};
    if (!is_single) return;
    for (const auto& [other, into] : all.groups) {
      if (other == id || other < cluster.tried_until || into.track.detections.size() < 2 ||
          FindBlock(all, into, block) != FindBlock(all, cluster, block)) {
        continue;
      }
      const auto by_body = [&](const Cluster& body, const Cluster& boxes) {
        return OddsOfBoxes(all.model, body.track, BoxesToPredict(boxes.track),
                           [&](int frame) { return all.model.Predict(body.track, frame); });
      };
      if (!all.model.MayShareSupport(into.track, part.track) ||
          Promise(all, into, part, std::max(by_body(into, part), by_body(part, into))) <= 0.0) {
        continue;
      }
      std::vector<int> both = into.track.detections;
      both.push_back(parts[i].front());
      Cluster taken_in =
          Evaluate(all, both, into.log_ratio + all.pairs.LogRatio(parts[i], into.track.detections),
                   {&into.track});
      const double gain_there =
          gain + into.cost - taken_in.cost - OnePlaceCost(all.model, rest, taken_in);
      if (gain_there > best.gain) best = {gain_there, rest, std::move(taken_in), other};
    }
  });
  const auto best = std::ranges::max_element(divisions, {}, &Division::gain);
  return best == divisions.end() ? Division() : *best;
}

// Divides each cluster where that lowers the cost most. True if there was any.
bool Divide(int block, Clustering* all) {
  bool has_divided = false;
  std::vector<int> ids;
  for (const auto& [id, group] : all->groups) ids.push_back(id);
  for (const int id : ids) {
    if (!all->groups.contains(id)) continue;
    Division division = BestDivision(block, id, *all);
    if (division.gain < kLeastGain) {
      all->groups.at(id).tried_until = all->next_id;
      continue;
    }
    Remove(division.to ? std::set{id, *division.to} : std::set{id}, all);
    for (Cluster* cluster : {&division.rest, &division.part}) {
      if (cluster->track.detections.size() > 1) {
        Cluster anew = Evaluate(*all, cluster->track.detections, cluster->log_ratio, {});
        if (anew.cost < cluster->cost) *cluster = std::move(anew);
      }
      Add(std::move(*cluster), all);
    }
    has_divided = true;
  }
  return has_divided;
}

}  // namespace

std::vector<bool> BestInFrames(const AssociationModel& model, const Track& track,
                               const std::vector<std::optional<BoxMatch>>& matches) {
  std::map<int, size_t> best;  // by frame
  for (size_t i = 0; i < matches.size(); ++i) {
    if (!matches[i]) continue;
    const int frame = model.DetectionAt(track.detections[i]).frame_index;
    const auto [at, is_first] = best.emplace(frame, i);
    // A box with an edge that is not the object's is of a part where another one is whole.
    const auto rank = [&](size_t k) {
      return std::pair(matches[k]->cut_edge.has_value(), matches[k]->cost);
    };
    if (!is_first && rank(i) < rank(at->second)) at->second = i;
  }
  std::vector<bool> is_best(matches.size(), false);
  for (const auto& [frame, i] : best) is_best[i] = true;
  return is_best;
}

Clusters ClusterDetections(const AssociationModel& model, const PairEvidence& pairs,
                           const std::vector<int>& detections, int threads) {
  Clustering all{model, pairs, threads};
  all.singles.resize(model.sequence().detections.size());
  ParallelFor("boxes", detections.size(), threads, [&](size_t i) {
    all.singles[detections[i]] = Evaluate(all, {detections[i]}, 0.0, {});
  });
  const std::vector<std::vector<int>> tracklets = Tracklets(all, detections);
  std::vector<Cluster> clusters(tracklets.size());
  ParallelFor("tracklets", tracklets.size(), threads, [&](size_t i) {
    double log_ratio = 0.0;
    std::vector<const Track*> parts;
    for (const int detection : tracklets[i]) {
      log_ratio += 0.5 * pairs.LogRatio({detection}, tracklets[i]);
      parts.push_back(&all.singles[detection].track);
    }
    clusters[i] = parts.size() == 1 ? all.singles[tracklets[i].front()]
                                    : Evaluate(all, tracklets[i], log_ratio, parts);
  });
  for (Cluster& cluster : clusters) Add(std::move(cluster), &all);
  Clusters result;
  const auto frames = static_cast<int>(model.sequence().frames.size());
  for (int block = kBlockFrames;; block *= 2) {
    for (auto& [id, group] : all.groups) group.tried_until = 0;
    result.is_settled = false;
    for (int round = 0; round < kMaxRounds && !result.is_settled; ++round) {
      for (const size_t partners : {size_t{1}, kMostPromising})
        MergeClusters(block, partners, &all);
      result.is_settled = !Divide(block, &all);
    }
    if (block >= frames) break;
  }
  for (auto& [id, group] : all.groups) result.all.push_back(std::move(group));
  return result;
}

double CostOfGroups(const AssociationModel& model, const PairEvidence& pairs,
                    const std::vector<std::vector<int>>& groups, int threads) {
  Clustering all{model, pairs, threads};
  all.singles.resize(model.sequence().detections.size());
  ParallelFor(all.singles.size(), threads,
              [&](size_t i) { all.singles[i] = Evaluate(all, {static_cast<int>(i)}, 0.0, {}); });
  std::vector<Cluster> clusters(groups.size());
  ParallelFor(groups.size(), threads, [&](size_t i) {
    double log_ratio = 0.0;
    for (const int detection : groups[i]) {
      log_ratio += 0.5 * pairs.LogRatio({detection}, groups[i]);
    }
    clusters[i] = Evaluate(all, groups[i], log_ratio, {});
  });
  double cost = 0.0;
  for (auto one = clusters.begin(); one != clusters.end(); ++one) {
    cost += one->cost;
    for (auto other = one + 1; other != clusters.end(); ++other) {
      cost += OnePlaceCost(model, *one, *other);
    }
  }
  return cost;
}

}  // namespace soslam
