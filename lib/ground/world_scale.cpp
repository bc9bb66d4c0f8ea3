// SPDX-License-Identifier: BSD-3-Clause
#include "ground/world_scale.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/text.h"
#include "ground/ground_checks.h"

namespace soslam {
namespace {

constexpr const char* kObjects = "objects";

// The settings that the scale is known by, in words.
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
  // A scale that is given does not rest on objects that contradict one another.
  for (const Finding& finding : findings) {
    if (finding.check == kKnownScaleCheck ||
        (finding.check == kObjectsCheck && estimate.known_scales.empty())) {
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
  return fmt::format("{}", fmt::join(words, " and "));
}

std::string ContradictionsInWords(const WorldScale& scale) {
  std::vector<std::string> words;
  for (const std::string& check : scale.contradicted_by) {
    const std::string what = check == kKnownScaleCheck
                                 ? fmt::format("{}", fmt::join(GivenInWords(scale), " or "))
                                 : "one another";
    words.push_back("the heights of objects contradict " + what);
  }
  return fmt::format("{}", fmt::join(words, ", and "));
}

}  // namespace soslam
