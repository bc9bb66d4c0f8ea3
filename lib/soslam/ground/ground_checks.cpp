// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/ground_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "soslam/base/text.h"
#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

constexpr const char* kGiveScale =
    "give scale or camera_height_m (SCALE or CAMERA_HEIGHT of make map), or the size of a thing "
    "(EDITS); lengths are only as good as the scale";

void CheckScale(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  constexpr double kUncertain = 0.25;  // of the logarithm
  if (!estimate.scale) {
    findings->push_back({"scale_unknown", Severity::kError,
                         fmt::format("none of {} objects has a label with a height and a body that "
                                     "fits its boxes; lengths have the unit of the input",
                                     estimate.objects.size()),
                         "objects with heights in the semantic table, scale or camera_height_m",
                         "too few boxes, or labels that the table does not have", kGiveScale});
    return;
  }
  if (estimate.scale->log_sigma < kUncertain) return;
  const WorldScale scale = *EstimateWorldScale(estimate, {});
  constexpr double kLeastDifference = 0.05;  // one that is seen in the words
  const int objects = estimate.AgreeingObjects();
  const double independent = estimate.IndependentObjects();
  std::string as_independent;
  if (objects - independent >= kLeastDifference) {
    as_independent =
        fmt::format("; as heights of one label are alike, {} as {:.1f}",
                    objects == 1 ? "this thing counts" : "these things count", independent);
  }
  findings->push_back(
      {"scale_uncertain", Severity::kWarning,
       fmt::format("the scale is known to +- {:.0f} % (95 %), from {}{}",
                   HalfIntervalPercent(scale), SourcesInWords(scale), as_independent),
       fmt::format("a standard deviation below {:.0f} %", 100.0 * kUncertain),
       "too few objects whose labels have heights, or heights that vary much", kGiveScale});
}

void CheckContradictions(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  constexpr double kOtherScales = 0.05;  // probability
  constexpr double kMisfit = 2.0;        // variance of heights, relative to that of the table
  constexpr double kAgreement = 0.5;     // share of the objects
  if (!estimate.scale_of_objects) return;
  const ScalePosterior& scale = *estimate.scale_of_objects;
  const auto agreeing =
      std::ranges::count_if(scale.agreement, [](double probability) { return probability >= 0.5; });
  const auto objects = static_cast<double>(scale.agreement.size());
  if (scale.second_mode_share < kOtherScales && scale.misfit < kMisfit &&
      static_cast<double>(agreeing) >= kAgreement * objects) {
    return;
  }
  findings->push_back(
      {kObjectsAgainstOneAnotherCheck, Severity::kWarning,
       fmt::format("{} of {} objects agree on a scale; their heights vary {:.1f} times as much as "
                   "those of their labels; another scale has a probability of {:.0f} %",
                   agreeing, scale.agreement.size(), std::sqrt(scale.misfit),
                   100.0 * scale.second_mode_share),
       "most objects have heights of their labels at one scale",
       "wrong labels, poses that drift, or objects of unusual size (a toy car)", kGiveScale});
}

// A value that gives the scale, as a file or setting has it.
std::string NameOfKnown(const KnownScale& known) {
  return known.setting == kSizeByHand ? "a size in edits.json" : known.setting;
}

// Two values of the scale may differ by this many standard deviations.
constexpr double kContradictionSigmas = 3.0;

// Settings against the heights of objects.
void CheckObjectsAgainstSettings(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  if (!estimate.scale_of_objects) return;
  const ScalePosterior& objects = *estimate.scale_of_objects;
  std::vector<std::string> contradicted;
  for (const KnownScale& known : estimate.known_scales) {
    const double difference = known.log_scale - objects.log_scale;
    const double sigma = std::hypot(known.log_sigma, objects.log_sigma);
    if (std::abs(difference) < kContradictionSigmas * sigma) continue;
    contradicted.push_back(fmt::format("{} makes objects {:.2f} times as high as their labels",
                                       NameOfKnown(known), std::exp(difference)));
  }
  if (contradicted.empty()) return;
  findings->push_back(
      {kObjectsAgainstSettingsCheck, Severity::kWarning,
       fmt::format("{}; the scale is {:.2f} times that of the objects alone",
                   fmt::join(contradicted, "; "),
                   std::exp(estimate.scale->log_scale - objects.log_scale)),
       fmt::format("1, within {} standard deviations of both; that of the objects is {:.0f} %",
                   kContradictionSigmas, 100.0 * objects.log_sigma),
       "a value in another unit; a floor that is not seen, so that camera_height_m was measured "
       "from the floor, and the lowest plane of points is a table top; or wrong labels",
       "check scale and camera_height_m (SCALE and CAMERA_HEIGHT of make map) and sizes in edits, "
       "or leave them out"});
}

// The two values of the scale that differ most, whether or not labels tell the scale.
void CheckSettingsAgainstEachOther(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  const std::vector<KnownScale>& known = estimate.known_scales;
  double most = kContradictionSigmas;
  std::optional<Finding> finding;
  for (auto one = known.begin(); one != known.end(); ++one) {
    for (auto other = one + 1; other != known.end(); ++other) {
      const double sigma = std::hypot(one->log_sigma, other->log_sigma);
      const double sigmas = std::abs(other->log_scale - one->log_scale) / sigma;
      if (sigmas < most) continue;
      most = sigmas;
      finding = {kSettingsAgainstEachOtherCheck,
                 Severity::kWarning,
                 fmt::format("1 unit of the input's world is {:.4g} m by {}, and {:.4g} m by {}",
                             std::exp(one->log_scale), NameOfKnown(*one),
                             std::exp(other->log_scale), NameOfKnown(*other)),
                 fmt::format("values that differ by less than {} of their standard deviations, "
                             "{:.0f} %",
                             kContradictionSigmas, 100.0 * sigma),
                 "a scale of a model in another unit, a size of another thing, or a camera height "
                 "above another plane than the lowest one of points (a table top where no floor is "
                 "seen)",
                 "check scale and camera_height_m (SCALE and CAMERA_HEIGHT of make map) and sizes "
                 "in edits, or leave one of them out"};
    }
  }
  if (finding) findings->push_back(*finding);
}

constexpr const char* kSeeWhetherUpright =
    "see in the map from the side whether objects stand upright. If not, take photos with the "
    "camera always held level, looking ahead, with more of the floor or table and of upright "
    "edges in them, such as door frames and table legs";

}  // namespace

std::vector<Finding> CheckGround(const GroundEstimate& estimate, const GroundOptions& options) {
  constexpr double kUncertainUpDeg = 2.0;
  std::vector<Finding> findings;
  CheckScale(estimate, &findings);
  for (const WorldReport::ObjectRow& object : estimate.objects) {
    if (!object.is_measured || object.log_scale) continue;
    findings.push_back(
        {"size_tells_nothing", Severity::kWarning,
         fmt::format("the size that edits give a {} ({} boxes) does not tell the scale",
                     object.label, object.boxes),
         "a thing that stands upright, with a label of the semantic table, whose body fits its "
         "boxes",
         "a label that is not in the table or may lie, or boxes of several things",
         "measure another thing, one that many photos show whole"});
  }
  CheckContradictions(estimate, &findings);
  CheckObjectsAgainstSettings(estimate, &findings);
  CheckSettingsAgainstEachOther(estimate, &findings);
  const bool has_used_height =
      std::ranges::count(estimate.known_scales, "camera_height_m", &KnownScale::setting) > 0;
  if (options.camera_height_m > 0.0 && !has_used_height) {
    findings.push_back({"camera_height_unused", Severity::kWarning,
                        "camera_height_m is given, and no horizontal plane below the cameras is "
                        "found",
                        "a plane that camera_height_m is the height above",
                        "a floor without texture has no points", "give scale instead"});
  }
  if (estimate.cameras_are_turned) {
    findings.push_back(
        {kCamerasTurnedCheck, Severity::kWarning,
         "which way is up is not clear: however the camera was held, most objects stand on no flat "
         "surface; the flat surfaces with most points and objects are taken to be level. If that "
         "is wrong, the map is tilted, and heights and scale are wrong with it",
         "cameras that are all held alike",
         "photos that were turned in different ways, or taken from one place, which makes "
         "surfaces of points come out tilted",
         kSeeWhetherUpright});
  }
  if (estimate.planes.empty()) {
    findings.push_back({"no_support_plane", Severity::kWarning,
                        fmt::format("no object stands on any of {} horizontal planes in {} points; "
                                    "support planes are those of boxes alone",
                                    estimate.planes_of_points, estimate.points),
                        "a floor or a table top with objects on it",
                        "surfaces without texture have no points",
                        "take photos that show more of the floor or table around the objects"});
  }
  if (kDegPerRad * estimate.tilt_sigma > kUncertainUpDeg) {
    findings.push_back({"up_uncertain", Severity::kWarning,
                        fmt::format("the standard deviation of up is {:.1f} degrees",
                                    kDegPerRad * estimate.tilt_sigma),
                        fmt::format("at most {:.0f} degrees", kUncertainUpDeg),
                        "few points on horizontal planes, or planes that are not parallel",
                        "look at the map from the side; more images from other directions"});
  }
  return findings;
}

namespace {

constexpr const char* kObjects = "objects";

// The settings that give the scale, in words.
std::vector<std::string> GivenInWords(const WorldScale& scale) {
  std::vector<std::string> words;
  for (const std::string& source : scale.found_by) {
    if (source == kObjects) continue;
    words.emplace_back(source == "scale"       ? "the scale given"
                       : source == kSizeByHand ? "sizes measured by hand"
                                               : "the camera's height given");
  }
  return words;
}

}  // namespace

std::optional<WorldScale> EstimateWorldScale(const GroundEstimate& estimate,
                                             const std::vector<Finding>& findings) {
  if (!estimate.scale) return std::nullopt;
  WorldScale scale{std::exp(estimate.scale->log_scale),
                   estimate.scale->log_sigma,
                   std::exp(estimate.scale->low),
                   std::exp(estimate.scale->high),
                   estimate.scale->trusted,
                   {},
                   estimate.AgreeingObjects(),
                   {},
                   estimate.IndependentObjects(),
                   {},
                   estimate.scale->misfit,
                   estimate.scale->second_mode_share};
  std::set<std::string> labels;
  for (const WorldReport::ObjectRow& object : estimate.objects) {
    if (object.TellsByLabel()) labels.insert(object.label);
  }
  scale.labels.assign(labels.begin(), labels.end());
  if (scale.objects > 0) scale.found_by.emplace_back(kObjects);
  for (const KnownScale& known : estimate.known_scales) {
    if (std::ranges::count(scale.found_by, known.setting) > 0) continue;
    scale.found_by.push_back(known.setting);
  }
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

WorldReport MakeReport(const GroundEstimate& estimate, const Sequence& input,
                       const std::vector<Finding>& findings) {
  WorldReport report;
  report.dataset = input.name;
  report.up = {estimate.up_in_input,
               kDegPerRad * estimate.tilt_sigma,
               estimate.planes.empty() ? "cameras" : "planes",
               estimate.cameras_are_turned ? "turned" : NameOf(estimate.up_of_cameras.orientation),
               estimate.verticals,
               kDegPerRad * estimate.cameras_tilt_sigma,
               kDegPerRad * estimate.tilt_to_cameras};
  report.up.probability = estimate.up_probability;
  for (const TriedOrientation& tried : estimate.up_of_cameras.orientations) {
    report.up.tried.push_back({tried.orientation, tried.cost, tried.probability});
  }
  report.scale = EstimateWorldScale(estimate, findings);
  report.output_from_input = estimate.output_from_input;
  for (int i = 0; i < std::ssize(estimate.planes); ++i) {
    const auto objects = std::ranges::count(estimate.objects, i, &WorldReport::ObjectRow::plane);
    report.planes.push_back({MakePlaneRow(estimate.planes[i], i), estimate.points_on_planes[i],
                             static_cast<int>(objects)});
  }
  report.points = estimate.points;
  report.planes_of_points = estimate.planes_of_points;
  report.objects = estimate.objects;
  return report;
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
