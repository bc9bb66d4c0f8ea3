// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yolo_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/error.h"

namespace soslam {
namespace {

using Rows = std::vector<YoloRow*>;

bool IsScore(double value) { return value >= 0.0 && value <= 1.0; }

bool IsTrack(double value) {
  return value >= -1.0 && value <= std::numeric_limits<int>::max() && value == std::floor(value);
}

// The first row whose extra violates `is_it`; null when there is none.
const YoloRow* FirstOther(const Rows& rows, size_t extra, bool (*is_it)(double)) {
  const auto found =
      std::ranges::find_if(rows, [&](const YoloRow* row) { return !is_it(row->extras[extra]); });
  return found == rows.end() ? nullptr : *found;
}

void SetScores(const Rows& rows, size_t extra) {
  for (YoloRow* row : rows) row->score = row->extras[extra];
}

void SetTracks(const Rows& rows, size_t extra) {
  for (YoloRow* row : rows) row->track = static_cast<int>(row->extras[extra]);
}

[[noreturn]] void Refuse(const YoloRow& row, const std::string& what) {
  throw InputError(fmt::format("{}: {}", row.place, what));
}

void ReadPairs(const Rows& rows) {
  const YoloRow* other = nullptr;
  for (const auto& [score, track] : {std::pair<size_t, size_t>{0, 1}, {1, 0}}) {
    const YoloRow* no_score = FirstOther(rows, score, &IsScore);
    const YoloRow* no_track = FirstOther(rows, track, &IsTrack);
    if (no_score == nullptr && no_track == nullptr) {
      SetScores(rows, score);
      SetTracks(rows, track);
      return;
    }
    if (other == nullptr) other = no_score != nullptr ? no_score : no_track;
  }
  Refuse(*other,
         fmt::format("has 7 numbers that end with {} {}; expected a confidence from 0 to 1 and the "
                     "integer of a track, in one order in all files (polygons of segmentation "
                     "labels are not read: save boxes)",
                     other->extras[0], other->extras[1]));
}

void RefuseTracksTwice(const Rows& rows) {
  std::set<std::pair<std::string, double>> seen;
  for (const YoloRow* row : rows) {
    const double track = row->extras[0];
    if (track <= 0.0 || seen.emplace(row->image, track).second) continue;
    Refuse(*row, fmt::format("has the sixth number {} twice in one image; expected a confidence "
                             "from 0 to 1, or the integer of a track, which no image has twice",
                             track));
  }
}

void ReadSingles(const Rows& rows, bool are_beside_pairs) {
  const YoloRow* no_score = FirstOther(rows, 0, &IsScore);
  if (no_score == nullptr) return SetScores(rows, 0);
  const YoloRow* no_track = FirstOther(rows, 0, &IsTrack);
  if (are_beside_pairs || no_track != nullptr) {
    Refuse(*no_score, fmt::format("has the sixth number {}; expected a confidence from 0 to 1{}",
                                  no_score->extras[0],
                                  are_beside_pairs ? ", as others have beside a track"
                                                   : ", or integers of tracks in all files"));
  }
  RefuseTracksTwice(rows);
  SetTracks(rows, 0);
}

}  // namespace

void ReadYoloExtras(std::vector<YoloRow>* rows) {
  Rows singles, pairs;
  for (YoloRow& row : *rows) {
    if (row.extras.size() == 1) singles.push_back(&row);
    if (row.extras.size() == 2) pairs.push_back(&row);
  }
  if (!pairs.empty()) ReadPairs(pairs);
  if (!singles.empty()) ReadSingles(singles, !pairs.empty());
}

}  // namespace soslam
