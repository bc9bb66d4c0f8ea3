// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "geometry/mirrored_points.h"
#include "image/neighbours.h"

namespace soslam {

// Mirrored pairs of the pixels of one observation, on the surfaces of many landmarks, compared by a
// descriptor that is a map's value at a pixel: kGrey and kDistanceTransform. Finds what
// SymmetryDescriptor finds pair by pair, in single precision: means are off by up to 1e-5.
class MirrorSearch {
 public:
  // `image` is of at least 2 x 2 pixels.
  MirrorSearch(const SymmetryImage& image, const Camera& camera, Descriptor descriptor,
               std::vector<Eigen::Vector2d> pixels);

  // A place of the mirror plane.
  struct Place {
    double NumPairs() const { return std::accumulate(pairs.begin(), pairs.end(), 0.0); }

    Eigen::Vector3f shift;          // what it adds to all mirror images, in the image
    double differences = 0.0;       // sum over pairs of d^2 / (d^2 + scale^2)
    std::array<int, 8> pairs = {};  // how many of every eighth point
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
  std::vector<Eigen::Vector2d> PixelsOfPairs(double place);

 private:
  MirrorSearch(const cv::Mat& map, const Camera& camera, std::vector<Eigen::Vector2d> pixels);

  // Before the points are looked up at these places and those in between.
  void Cover(double least_place, double largest_place);
  Eigen::Vector3f Shift(double place) const { return (place * shift_by_place_).cast<float>(); }
  // Adds batches to what each place comes to.
  void Add(size_t first, size_t end, double scale, std::span<Place* const> places);

  Neighbours map_;
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<size_t> order_;  // in which they are compared
  std::vector<float> values_;  // at the pixels in that order; NaN where there is none
  PixelRays rays_;             // in that order

  // Of the landmark.
  MirroredPoints points_;
  std::vector<float> values_of_points_;
  Eigen::Vector3d shift_by_place_ = Eigen::Vector3d::Zero();
  bool are_inside_ = false;  // the points' pixels at all places, in the map

  std::vector<Place> places_;
  std::vector<Place*> open_;  // places that may still be the best
  size_t last_least_ = 0;     // the best place of the last landmark
};

}  // namespace soslam
