// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/track_labels.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <tuple>

#include "base/error.h"

namespace soslam {
namespace {

struct Votes {
  int rows = 0;
  double score = 0.0;
};

// Votes of the rows of one object, keyed by label.
using Ballot = std::map<std::string, Votes>;

std::string Winner(const Ballot& ballot) {
  auto best = ballot.begin();
  for (auto votes = ballot.begin(); votes != ballot.end(); ++votes) {
    if (std::tuple(votes->second.rows, votes->second.score) >
        std::tuple(best->second.rows, best->second.score)) {
      best = votes;
    }
  }
  return best->first;
}

std::map<int, Ballot> Count(const std::vector<DetectionRow>& rows) {
  std::map<int, Ballot> ballots;
  for (const DetectionRow& row : rows) {
    Votes& votes = ballots[row.object_id][row.label];
    ++votes.rows;
    votes.score += row.score;
  }
  return ballots;
}

void RefuseOtherThanListed(const ListedObject& object, const Ballot& ballot,
                           const std::vector<DetectionRow>& rows) {
  int all = 0, others = 0;
  for (const auto& [label, votes] : ballot) {
    all += votes.rows;
    if (label != object.label) others += votes.rows;
  }
  if (2 * others <= all) return;
  for (const DetectionRow& row : rows) {
    if (row.object_id != object.id || row.label == object.label) continue;
    throw InputError(fmt::format(
        "{}: label of object {} is '{}', as another than '{}' is in {} of its {} boxes; expected "
        "'{}', as in objects.json",
        row.place, row.object_id, row.label, object.label, others, all, object.label));
  }
}

}  // namespace

int UnifyLabels(const std::vector<ListedObject>& objects, std::vector<DetectionRow>* rows) {
  const std::map<int, Ballot> ballots = Count(*rows);
  std::map<int, std::string> labels;
  for (const auto& [id, ballot] : ballots) labels[id] = Winner(ballot);
  for (const ListedObject& object : objects) {
    const auto ballot = ballots.find(object.id);
    if (ballot == ballots.end()) continue;
    RefuseOtherThanListed(object, ballot->second, *rows);
    labels[object.id] = object.label;
  }
  int changed = 0;
  for (DetectionRow& row : *rows) {
    if (row.label == labels.at(row.object_id)) continue;
    row.label = labels.at(row.object_id);
    ++changed;
  }
  return changed;
}

}  // namespace soslam
