// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "geometry/mirrored_points.h"

namespace soslam {

// Mirrored pairs of the pixels of one observation, on the surfaces of many landmarks, compared by a
// descriptor that is a map's value at a pixel: kGrey and kDistanceTransform. Finds what
// SymmetryDescriptor finds pair by pair, in single precision: means are off by up to 1e-5.
class MirrorSearch {
 public:
  // `image` has to outlive it; of at least 2 x 2 pixels.
  MirrorSearch(const SymmetryImage& image, const Camera& camera, Descriptor descriptor,
               std::vector<Eigen::Vector2d> pixels);

  // Over pairs.
  struct Sums {
    double differences = 0.0;  // d^2 / (d^2 + scale^2)
    double pairs = 0.0;
  };

  // The landmark that the following is about.
  void See(const Landmark& landmark_in_camera, double min_viewing_cosine);
  // How many pixels show it.
  size_t NumSamples() const { return points_.on_surface; }

  // The place of the mirror plane (see VisibleSurface::MirrorImage) where the mean over the pairs
  // of d^2 / (d^2 + scale^2), d the descriptor difference, is the least; of equal ones the first.
  // Places with fewer than `min_pairs` pairs do not count; none when no place does.
  struct Least {
    double mean;
    size_t place;
  };
  std::optional<Least> FindLeast(const std::vector<double>& places, double scale, double min_pairs);
  // One pixel of each pair at a place, in their order.
  std::vector<Eigen::Vector2d> PixelsOfPairs(double place) const;

 private:
  struct Place {
    size_t index;
    Eigen::Vector3f shift;  // what it adds to all mirror images, in the image
    Sums sums;
  };

  Eigen::Vector3f Shift(double place) const { return (place * shift_by_place_).cast<float>(); }
  // Adds what batches from `first` on come to at a place, as long as that is no more than `enough`.
  void Add(size_t first, size_t end, double enough, double scale, Place* place) const;

  const cv::Mat map_;  // CV_32FC1
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<size_t> order_;  // in which they are compared
  std::vector<float> values_;  // at the pixels in that order; NaN where there is none
  PixelRays rays_;             // in that order

  // Of the landmark.
  MirroredPoints points_;
  std::vector<float> values_of_points_;
  Eigen::Vector3d shift_by_place_ = Eigen::Vector3d::Zero();

  std::vector<Place> places_;
};

}  // namespace soslam
