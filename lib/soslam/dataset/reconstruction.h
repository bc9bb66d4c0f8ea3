// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/dataset/colmap_model.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/model/finding.h"
#include "soslam/model/map_points.h"
#include "soslam/model/reconstruction.h"

namespace soslam {

// Poses and points of a COLMAP model for the images of a dataset.
struct Reconstruction {
  std::vector<std::optional<Rigid3d>> world_from_camera;  // one per listed image
  std::vector<MapPoint> points;                           // sorted by COLMAP's id
  std::vector<std::string> unlisted;                      // images of the model that are left out
};

// Assigns the images of a model to those of the list by name (FrameLookup). Images that are not
// listed are left out with their observations, and points with them that no listed image sees.
// Observations are sorted by frame. Throws InputError when an image has two poses, and when none is
// listed.
Reconstruction BuildReconstruction(const ColmapModel& model,
                                   const std::vector<ListedImage>& images);

// Numbers of images and points, images without a pose, and medians; the rest is left as it is.
void Summarise(const Reconstruction& reconstruction, const std::vector<ListedImage>& images,
               ReconstructionSummary* summary);

// Finds fewer than 80 % of the images registered, more than one component, and a median
// triangulation angle of less than 2 degrees where the poses are estimated. `unlisted`: images of
// the model that the dataset does not list.
std::vector<Finding> CheckReconstruction(const ReconstructionSummary& summary,
                                         const std::vector<std::string>& unlisted);

}  // namespace soslam
