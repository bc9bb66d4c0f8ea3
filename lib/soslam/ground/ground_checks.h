// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soslam/ground/estimate_ground.h"
#include "soslam/model/finding.h"
#include "soslam/model/world.h"

namespace soslam {

// The check whose finding means that up may be quite wrong: only planes tell it.
inline constexpr const char* kCamerasTurnedCheck = "cameras_turned";

// A scale that cannot be told or is uncertain, and what contradicts it; a camera height that says
// nothing; an up direction that is uncertain; no support plane.
std::vector<Finding> CheckGround(const GroundEstimate& estimate, const GroundOptions& options);

// Checks of CheckGround whose findings contradict a scale: the heights of objects contradict the
// settings that give it, or one another; these settings contradict each other.
inline constexpr const char* kObjectsAgainstSettingsCheck = "scale_of_objects_differs";
inline constexpr const char* kObjectsAgainstOneAnotherCheck = "scale_contradicted";
inline constexpr const char* kSettingsAgainstEachOtherCheck = "settings_of_scale_differ";

// Empty where nothing tells the scale. `findings`: of CheckGround.
std::optional<WorldScale> EstimateWorldScale(const GroundEstimate& estimate,
                                             const std::vector<Finding>& findings);

// `findings`: of CheckGround.
WorldReport MakeReport(const GroundEstimate& estimate, const Sequence& input,
                       const std::vector<Finding>& findings);

// Half the 95 % interval, in per cent of its geometric middle.
double HalfIntervalPercent(const WorldScale& scale);

// "the usual heights of 9 detected things and the camera's height given"; "objects that contradict
// one another" where no object agrees with the scale and no setting gives it.
std::string SourcesInWords(const WorldScale& scale);

// "the heights of objects contradict the camera's height given"; empty where nothing contradicts
// the scale.
std::string ContradictionsInWords(const WorldScale& scale);

}  // namespace soslam
