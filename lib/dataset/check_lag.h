// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "dataset/tracked_rays.h"
#include "model/finding.h"

namespace soslam {

// Poses that are a constant time late or early, of which the seconds and the images are measured,
// or frames that are counted from 1: rays meet clearly better from the poses of other times.
std::vector<Finding> CheckLag(const ImportView& view, const std::vector<TrackedObject>& objects,
                              const RayError& as_read);

}  // namespace soslam
