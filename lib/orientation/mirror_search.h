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
// descriptor that is a map's value at a pixel: kGrey and kDistanceTransform. The batched equivalent
// of SymmetryDescriptor, in single precision: means are off by up to 1e-5.
class MirrorSearch {
 public:
  // `image` has at least 2 x 2 pixels.
  MirrorSearch(const SymmetryImage& image, const Camera& camera, Descriptor descriptor,
               std::vector<Eigen::Vector2d> pixels);

  // Sums for one candidate offset of the mirror plane.
  struct Candidate {
    double NumPairs() const { return std::accumulate(pairs.begin(), pairs.end(), 0.0); }

    Eigen::Vector3f shift;          // added to all mirror images, in homogeneous image coordinates
    double differences = 0.0;       // sum over pairs of d^2 / (d^2 + scale^2)
    std::array<int, 8> pairs = {};  // number of pairs, by point index modulo 8
  };

  // Sets the landmark for the functions below.
  void SetLandmark(const Landmark& landmark_in_camera, double min_viewing_cosine);
  // Number of pixels whose rays meet the landmark.
  size_t NumSamples() const { return points_.on_surface; }

  // The candidate offset of the mirror plane (see VisibleSurface::MirrorImage) with the smallest
  // mean over the pairs of d^2 / (d^2 + scale^2), d the descriptor difference; of equal ones the
  // first. Candidates with fewer than `min_pairs` pairs are skipped; none when all are.
  struct Minimum {
    double mean;
    size_t place;
  };
  std::optional<Minimum> FindMinimum(const std::vector<double>& places, double scale,
                                     double min_pairs);
  // One pixel of each pair at a given offset, in the order of `pixels`.
  std::vector<Eigen::Vector2d> PixelsOfPairs(double place);

 private:
  MirrorSearch(const cv::Mat& map, const Camera& camera, std::vector<Eigen::Vector2d> pixels);

  // Prepares the map for lookups at these offsets and those in between.
  void SelectInBounds(double least_place, double largest_place);
  Eigen::Vector3f Shift(double place) const { return (place * shift_by_place_).cast<float>(); }
  // Adds batches of points to the sums of each candidate.
  void Add(size_t first, size_t end, double scale, std::span<Candidate* const> places);

  Neighbours map_;
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<size_t> order_;  // order of comparison
  std::vector<float> values_;  // map values at the pixels in that order; NaN if there is none
  PixelRays rays_;             // in that order

  // State for the current landmark.
  MirroredPoints points_;
  std::vector<float> values_of_points_;
  Eigen::Vector3d shift_by_place_ = Eigen::Vector3d::Zero();
  bool are_inside_ = false;  // true if the points' pixels are inside the map at all offsets

  std::vector<Candidate> places_;
  std::vector<Candidate*> open_;  // candidates that may still be the best
  size_t last_least_ = 0;         // the best candidate for the last landmark
};

}  // namespace soslam
