// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/describe_estimates.h"

#include <functional>

namespace soslam {

std::map<std::string, int> CountFailures(const LandmarkEstimates& estimates) {
  std::map<std::string, int> failures;
  const auto count = [&](const auto& all) {
    for (const auto& one : all) {
      if (!one.failure.empty()) ++failures[one.failure];
    }
  };
  count(estimates.observations);
  count(estimates.objects);
  return failures;
}

std::string RowsViolation(const std::vector<FramePose>& trajectory,
                          const std::vector<PlaneEstimate>& planes, const Sequence* sequence) {
  if (sequence == nullptr) return "";
  const auto violation = [](const char* list, const auto& rows, auto index, const auto& items) {
    if (rows.size() != items.size()) {
      return fmt::format("/{} has {} rows; expected {}, as the sequence", list, rows.size(),
                         items.size());
    }
    for (size_t i = 0; i < rows.size(); ++i) {
      const size_t found = std::invoke(index, rows[i]);
      if (found == i) continue;
      return fmt::format("/{}/{} is of {}; expected {}, as in the sequence", list, i,
                         items.at(found).id, items[i].id);
    }
    return std::string();
  };
  const std::string of_frames =
      violation("trajectory", trajectory, &FramePose::frame_index, sequence->frames);
  return of_frames.empty()
             ? violation("planes", planes, &PlaneEstimate::plane_index, sequence->planes)
             : of_frames;
}

}  // namespace soslam
