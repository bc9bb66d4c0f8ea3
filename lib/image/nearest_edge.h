// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace soslam {

// The nearest edge pixel u^E of each pixel, eq. (20), exact: CV_16SC2, (x, y). Of several at the
// same distance it is the leftmost, and in a column the upper one. (-1, -1) everywhere when there
// is no edge. `edges` is CV_8UC1, not 0 on edge pixels, with at most 32767 pixels a side.
cv::Mat NearestEdgeMap(const cv::Mat& edges);

// Distance (px) from each pixel to its entry in such a map, eq. (17): CV_32FC1; infinite where
// there is no edge.
cv::Mat DistanceMap(const cv::Mat& nearest_edge);

}  // namespace soslam
