// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <string>

#include "image/edge_maps.h"
#include "model/estimates.h"

namespace soslam {

// Layers of a picture of a frame's edge maps.
enum class EdgeLayer { kAll, kGrey, kEdges, kDistance, kNearest };
inline constexpr std::array kEdgeLayerNames = {"all", "grey", "edges", "distance", "nearest"};

// One layer, or all of them side by side, in colour (CV_8UC3), each with a caption: the image with
// its corners; the edges; the distance transform, bright for large distances; the direction to the
// nearest edge as hue.
cv::Mat EdgesPicture(const EdgeMaps& maps, EdgeLayer layer, const std::string& title);

// The pixels that are used for symmetry and their mirror pixels, joined in pairs, on the part of
// `image` (CV_8UC1) around them.
cv::Mat SymmetryPicture(const SymmetryRecord& record, const cv::Mat& image,
                        const std::string& title);

}  // namespace soslam
