// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace soslam {

// For each pixel the nearest edge pixel u^E of eq. (20), exactly: CV_16SC2, (x, y); of several at
// the same distance the leftmost, of those in its column the upper one. (-1, -1) everywhere when
// there is no edge. `edges` is CV_8UC1, edge pixels are those that are not 0, at most 32767 pixels
// a side.
cv::Mat NearestEdgeMap(const cv::Mat& edges);

// The distance (px) of each pixel to its entry in such a map, eq. (17): CV_32FC1; infinite where
// there is no edge.
cv::Mat DistanceMap(const cv::Mat& nearest_edge);

}  // namespace soslam
