// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/edits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

constexpr double kLeastOverlap = 0.9;
// Boxes whose overlaps differ by less fit an anchor alike.
constexpr double kLeastLead = 0.02;

std::string InWords(const Box& box) {
  return fmt::format("[{:.1f}, {:.1f}, {:.1f}, {:.1f}]", box.x_min, box.y_min, box.x_max,
                     box.y_max);
}

// The one frame with the image of an anchor.
int FindFrame(const BoxAnchor& anchor, const Sequence& sequence, const std::string& place) {
  std::vector<int> of_name;  // without folders
  std::vector<std::string> names;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const std::string& image = sequence.frames[i].image;
    if (image.empty()) continue;
    if (image == anchor.image) return static_cast<int>(i);
    names.push_back(std::filesystem::path(image).filename().string());
    if (names.back() == anchor.image) of_name.push_back(static_cast<int>(i));
  }
  if (of_name.size() == 1) return of_name.front();
  if (of_name.size() > 1) {
    throw InputError(
        fmt::format("{}/image is \"{}\", as {} images are called; expected one of them "
                    "with its folder, as \"{}\"",
                    place, anchor.image, of_name.size(), sequence.frames[of_name.front()].image));
  }
  if (names.empty()) {
    throw InputError(
        fmt::format("{}/image is \"{}\"; expected no edits, as none of the {} frames "
                    "has an image",
                    place, anchor.image, sequence.frames.size()));
  }
  std::ranges::sort(names);
  const std::string name = std::filesystem::path(anchor.image).filename().string();
  const auto next = std::ranges::lower_bound(names, name);
  throw InputError(fmt::format(
      "{}/image is \"{}\"; expected one of the {} images that are used; the nearest by name is "
      "\"{}\"",
      place, anchor.image, names.size(),
      LikelyMeant(name, names).value_or(next == names.end() ? names.back() : *next)));
}

// The box of the frame that is nearest to the anchor, in words.
std::string NearestInWords(const Box& box, const Sequence& sequence, int frame) {
  double nearest_px = std::numeric_limits<double>::infinity();
  std::string words = "none, as the image has no box";
  const auto compare = [&](const Box& other, const std::string& label, const std::string& why) {
    const double distance_px =
        std::abs(box.x_min - other.x_min) + std::abs(box.y_min - other.y_min) +
        std::abs(box.x_max - other.x_max) + std::abs(box.y_max - other.y_max);
    if (distance_px >= nearest_px) return;
    nearest_px = distance_px;
    words = fmt::format("{} of \"{}\", overlap {:.2f}{}", InWords(other), label,
                        BoxOverlap(box, other), why);
  };
  for (const Detection& detection : DetectionsIn(sequence, frame)) {
    compare(detection.box, sequence.ObjectOf(detection).label, "");
  }
  for (const RejectedDetection& rejected : sequence.rejected) {
    if (rejected.frame_index != frame) continue;
    compare(
        rejected.box, rejected.label,
        fmt::format(", which the stage {} left out: {}", NameOf(rejected.stage), rejected.reason));
  }
  return words;
}

int FindDetection(const BoxAnchor& anchor, const Sequence& sequence,
                  const std::vector<DetectionDecision>& decisions, const std::string& place) {
  const int frame = FindFrame(anchor, sequence, place);
  std::map<int, double> overlaps;  // by detection
  for (const Detection& detection : DetectionsIn(sequence, frame)) {
    auto index = static_cast<int>(&detection - sequence.detections.data());
    if (decisions[index].duplicate_of >= 0) index = decisions[index].duplicate_of;
    double& overlap = overlaps[index];
    overlap = std::max(overlap, BoxOverlap(detection.box, anchor.box));
  }
  std::vector<std::pair<double, int>> fitting;  // best first
  for (const auto& [index, overlap] : overlaps) {
    if (overlap >= kLeastOverlap) fitting.emplace_back(overlap, index);
  }
  std::ranges::sort(fitting, std::ranges::greater());
  if (fitting.empty()) {
    throw InputError(
        fmt::format("{}/box is {} in image \"{}\"; expected a box with an overlap of at least {}; "
                    "the nearest is "
                    "{}",
                    place, InWords(anchor.box), sequence.frames[frame].image, kLeastOverlap,
                    NearestInWords(anchor.box, sequence, frame)));
  }
  if (fitting.size() > 1 && fitting[0].first - fitting[1].first < kLeastLead) {
    const auto words = [&](int index) {
      const Detection& detection = sequence.detections[index];
      return fmt::format("{} of \"{}\"", InWords(detection.box),
                         sequence.ObjectOf(detection).label);
    };
    throw InputError(
        fmt::format("{}/box is {} in image \"{}\", which fits two boxes alike, {} and {}; expected "
                    "a box as one "
                    "of them is, or another image",
                    place, InWords(anchor.box), sequence.frames[frame].image,
                    words(fitting[0].second), words(fitting[1].second)));
  }
  return fitting.front().second;
}

[[noreturn]] void ThrowContradiction(const Edits& edits, int edit, int other,
                                     const std::string& why) {
  throw InputError(
      fmt::format("{}: /edits/{} ({}) contradicts /edits/{} ({}): {}; expected one of "
                  "the two",
                  edits.file, edit, NameOf(edits.edits[edit].kind), other,
                  NameOf(edits.edits[other].kind), why));
}

// True if one object cannot be as both edits say.
bool Contradict(const Edit& one, const Edit& other) {
  const auto differ = [](const auto& of_one, const auto& of_other) {
    return of_one && of_other && *of_one != *of_other;
  };
  return (one.kind == EditKind::kDelete) != (other.kind == EditKind::kDelete) ||
         (one.kind == other.kind && one.label != other.label) ||
         differ(one.size.depth_m, other.size.depth_m) ||
         differ(one.size.width_m, other.size.width_m) ||
         differ(one.size.height_m, other.size.height_m);
}

}  // namespace

FoundEdits FindBoxes(const Edits& edits, const Sequence& sequence,
                     const std::vector<DetectionDecision>& decisions) {
  FoundEdits found{edits, {}, {}};
  for (size_t i = 0; i < edits.edits.size(); ++i) {
    found.boxes.emplace_back();
    for (size_t k = 0; k < edits.edits[i].boxes.size(); ++k) {
      const int detection = FindDetection(edits.edits[i].boxes[k], sequence, decisions,
                                          fmt::format("{}: /edits/{}/boxes/{}", edits.file, i, k));
      found.boxes[i].push_back(detection);
      if (edits.edits[i].kind == EditKind::kDeleteBoxes) {
        found.deleted.emplace(detection, static_cast<int>(i));
      }
    }
  }
  for (size_t i = 0; i < edits.edits.size(); ++i) {
    if (edits.edits[i].kind == EditKind::kDeleteBoxes) continue;
    for (const int detection : found.boxes[i]) {
      const auto deleted = found.deleted.find(detection);
      if (deleted == found.deleted.end()) continue;
      ThrowContradiction(edits, static_cast<int>(i), deleted->second,
                         "the one needs the box that the other deletes");
    }
  }
  return found;
}

std::vector<Cluster> WithEdits(const AssociationModel& model, const FoundEdits& found,
                               std::vector<Cluster> clusters) {
  const std::vector<Edit>& edits = found.edits.edits;
  if (edits.empty()) return clusters;
  const auto edit_count = static_cast<int>(edits.size());
  const auto cluster_count = static_cast<int>(clusters.size());
  std::map<int, int> cluster_of, group_of;  // by box; groups are clusters, then one for each edit
  std::set<int> used;                       // boxes that a body explained, or that edits group
  for (int c = 0; c < cluster_count; ++c) {
    for (size_t i = 0; i < clusters[c].is_used.size(); ++i) {
      const int box = clusters[c].track.detections[i];
      cluster_of[box] = c;
      if (clusters[c].is_used[i]) used.insert(box);
    }
  }
  group_of = cluster_of;
  for (int e = 0; e < edit_count; ++e) {
    if (edits[e].kind != EditKind::kSplit) continue;
    for (const int box : found.boxes[e]) {
      const int split_by = group_of.at(box) - cluster_count;
      if (split_by >= 0 && split_by != e) {
        ThrowContradiction(found.edits, e, split_by, "both split off the same box");
      }
      group_of[box] = cluster_count + e;
    }
  }
  std::vector<int> joined_to(clusters.size() + edits.size());  // another group, or the group itself
  std::iota(joined_to.begin(), joined_to.end(), 0);
  const auto object_of = [&](int box) {
    int group = group_of.at(box);
    while (joined_to[group] != group) group = joined_to[group];
    return group;
  };
  // A split that a join undoes: a box that it parts from its boxes is joined to them.
  const auto undone_split = [&]() -> std::optional<int> {
    for (const auto& box_and_group : group_of) {
      const int box = box_and_group.first;
      for (int e = 0; e < edit_count; ++e) {
        if (edits[e].kind != EditKind::kSplit || group_of.at(box) == cluster_count + e) continue;
        const auto is_undone = [&](int split) {
          return cluster_of.at(split) == cluster_of.at(box) && object_of(split) == object_of(box);
        };
        if (std::ranges::any_of(found.boxes[e], is_undone)) return e;
      }
    }
    return std::nullopt;
  };
  for (int e = 0; e < edit_count; ++e) {
    const std::vector<int>& boxes = found.boxes[e];
    if (edits[e].kind != EditKind::kJoin && edits[e].kind != EditKind::kSplit) continue;
    used.insert(boxes.begin(), boxes.end());
    const auto segment_of = [&](int box) {
      return model.sequence().FrameOf(model.DetectionAt(box)).segment;
    };
    for (size_t i = 1; i < boxes.size(); ++i) {
      if (segment_of(boxes[i]) != segment_of(boxes.front())) {
        throw InputError(
            fmt::format("{}: /edits/{}/boxes/{} is of another recording than the first "
                        "box; expected boxes in one world",
                        found.edits.file, e, i));
      }
      if (edits[e].kind == EditKind::kJoin) joined_to[object_of(boxes[i])] = object_of(boxes[0]);
    }
    if (const auto split = undone_split(); split && edits[e].kind == EditKind::kJoin) {
      ThrowContradiction(found.edits, e, *split, "the one joins what the other splits");
    }
  }
  std::map<int, std::vector<int>> edits_of;  // by object
  for (int e = 0; e < edit_count; ++e) {
    if (edits[e].kind == EditKind::kDeleteBoxes) continue;
    for (const int box : found.boxes[e]) {
      std::vector<int>& named_by = edits_of[object_of(box)];
      for (const int other : named_by) {
        if (!Contradict(edits[e], edits[other])) continue;
        ThrowContradiction(found.edits, e, other, "both are of one object");
      }
      named_by.push_back(e);
    }
  }
  std::map<int, std::vector<int>> boxes_of;  // by object, in the order of the sequence
  for (const auto& [box, group] : group_of) boxes_of[object_of(box)].push_back(box);
  std::vector<Cluster> edited;
  for (const auto& [object, boxes] : boxes_of) {
    Cluster& cluster = edited.emplace_back();
    std::set<int> grouped;
    if (object < cluster_count && boxes == clusters[object].track.detections) {
      cluster = std::move(clusters[object]);
    } else {
      cluster.track.detections = boxes;
      cluster.track.plane_index = model.PlaneOf(model.DetectionAt(boxes.front()));
      for (const int box : boxes) {
        const Detection& detection = model.DetectionAt(box);
        cluster.track.votes[model.LabelOf(detection)] += detection.score;
        cluster.is_used.push_back(used.contains(box));
        if (cluster.is_used.back()) grouped.insert(box);
      }
      cluster.matches.resize(boxes.size());
    }
    const auto named_by = edits_of.find(object);
    if (named_by == edits_of.end()) continue;
    ByHand& by_hand = cluster.track.by_hand.emplace();
    by_hand.grouped = std::move(grouped);
    for (const int e : named_by->second) {
      if (edits[e].kind == EditKind::kJoin || edits[e].kind == EditKind::kSplit) {
        for (const int box : found.boxes[e]) {
          if (object_of(box) == object) by_hand.named.insert(box);
        }
      }
      if (edits[e].kind == EditKind::kDelete) by_hand.is_deleted = true;
      if (edits[e].kind == EditKind::kRename) by_hand.label = edits[e].label;
      if (edits[e].size.depth_m) by_hand.size.depth_m = edits[e].size.depth_m;
      if (edits[e].size.width_m) by_hand.size.width_m = edits[e].size.width_m;
      if (edits[e].size.height_m) by_hand.size.height_m = edits[e].size.height_m;
    }
  }
  return edited;
}

std::vector<Finding> CheckEdits(const Sequence& sequence, const Association& association) {
  std::vector<std::string> lost;
  for (const Track& track : association.tracks) {
    if (!track.by_hand || track.fate != TrackFate::kNoLandmark) continue;
    const Detection& detection = sequence.detections[track.boxes.front()];
    lost.push_back(fmt::format("box {} in image \"{}\"", InWords(detection.box),
                               sequence.FrameOf(detection).image));
  }
  if (lost.empty()) return {};
  return {{"edits_without_body", Severity::kWarning,
           fmt::format("no body fits the object that edits name by {}", fmt::join(lost, ", ")),
           "a body for each object that edits name",
           "a label that no support plane suits, a size in another unit than metres, or boxes of "
           "several things",
           "mend edits.json: rename to another label, correct the size, or split"}};
}

}  // namespace soslam
