// SPDX-License-Identifier: BSD-3-Clause
#include "ground/world_scale.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/text.h"

namespace soslam {
namespace {

constexpr const char* kObjects = "objects";

// The settings that give the scale, in words.
std::vector<std::string> GivenInWords(const WorldScale& scale) {
  std::vector<std::string> words;
  for (const std::string& source : scale.found_by) {
    if (source == kObjects) continue;
    words.emplace_back(source == "scale" ? "the scale given" : "the camera's height given");
  }
  return words;
}

}  // namespace

std::optional<WorldScale> WorldScaleOf(const GroundEstimate& estimate,
                                       const std::vector<Finding>& findings) {
  if (!estimate.scale) return std::nullopt;
  WorldScale scale{std::exp(estimate.scale->log_scale),
                   estimate.scale->log_sigma,
                   std::exp(estimate.scale->low),
                   std::exp(estimate.scale->high),
                   {},
                   estimate.AgreeingObjects(),
                   {}};
  if (scale.objects > 0) scale.found_by.emplace_back(kObjects);
  for (const KnownScale& known : estimate.known_scales) scale.found_by.push_back(known.setting);
  // A scale that settings alone give does not rest on objects that contradict one another.
  const bool rests_on_objects = scale.objects > 0 || estimate.known_scales.empty();
  for (const Finding& finding : findings) {
    if (finding.check == kObjectsAgainstSettingsCheck ||
        finding.check == kSettingsAgainstEachOtherCheck ||
        (finding.check == kObjectsAgainstOneAnotherCheck && rests_on_objects)) {
      scale.contradicted_by.push_back(finding.check);
    }
  }
  return scale;
}

double HalfIntervalPercent(const WorldScale& scale) {
  return 100.0 * (std::sqrt(scale.high / scale.low) - 1.0);
}

std::string SourcesInWords(const WorldScale& scale) {
  std::vector<std::string> words = GivenInWords(scale);
  if (scale.objects > 0) {
    words.insert(words.begin(), "the usual heights of " +
                                    Counted(static_cast<size_t>(scale.objects), "detected thing"));
  }
  if (words.empty()) return "objects that contradict one another";
  return fmt::format("{}", fmt::join(words, " and "));
}

std::string ContradictionsInWords(const WorldScale& scale) {
  std::vector<std::string> words;
  for (const std::string& check : scale.contradicted_by) {
    if (check == kSettingsAgainstEachOtherCheck) {
      words.push_back(
          fmt::format("{} contradict each other", fmt::join(GivenInWords(scale), " and ")));
    } else if (check == kObjectsAgainstSettingsCheck) {
      words.push_back(fmt::format("the heights of objects contradict {}",
                                  fmt::join(GivenInWords(scale), " or ")));
    } else {
      words.emplace_back("the heights of objects contradict one another");
    }
  }
  return fmt::format("{}", fmt::join(words, ", and "));
}

}  // namespace soslam
