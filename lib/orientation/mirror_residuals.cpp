// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_residuals.h"

#include <cmath>
#include <limits>

#include "base/wide_loops.h"
#include "geometry/body_in_camera.h"
#include "image/sample_bilinear.h"
#include "initialisation/residual_batch.h"

namespace soslam {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Mirror images in the camera frame, and their pixels; NaN behind the camera.
struct MirrorImages {
  BatchOfVectors in_camera;
  Batch inverse_depth;
  BatchOfPixels pixels;
};

// `place` (m) is the offset of the mirror plane along the object's y axis.
SOSLAM_MULTIVERSION void Mirror(const Camera& camera, const BodyInCamera& body,
                                const BatchOfVectors& points, double place, MirrorImages* images) {
  const Eigen::Matrix3d rotation = body.rotation;
  const Eigen::Vector3d centre = body.centre;
  for (int k = 0; k < 3; ++k) {
    const double a = rotation(k, 0), b = rotation(k, 1), c = rotation(k, 2), origin = centre[k];
    Batch& along = images->in_camera[static_cast<size_t>(k)];
    for (int i = 0; i < kBatchSize; ++i) {
      along[i] = a * points[0][i] + b * (2.0 * place - points[1][i]) + c * points[2][i] + origin;
    }
  }
  const double fx = camera.fx, fy = camera.fy, cx = camera.cx, cy = camera.cy;
  for (int i = 0; i < kBatchSize; ++i) {
    const double depth = images->in_camera[2][i];
    const double inverse_depth = 1.0 / depth + (depth > 0.0 ? 0.0 : kNone);
    images->inverse_depth[i] = inverse_depth;
    images->pixels[0][i] = fx * images->in_camera[0][i] * inverse_depth + cx;
    images->pixels[1][i] = fy * images->in_camera[1][i] * inverse_depth + cy;
  }
}

// The derivative of a map's value at the pixel of a mirror image by that image, in the object
// frame; 0 where `scale` is 0.
SOSLAM_MULTIVERSION void ByImage(const Camera& camera, const Eigen::Matrix3d& rotation,
                                 const MirrorImages& images, const BatchOfPixels& gradients,
                                 const Batch& scale, BatchOfVectors* by_image) {
  const double fx = camera.fx, fy = camera.fy;
  for (int i = 0; i < kBatchSize; ++i) {
    const double inverse_depth = scale[i] != 0.0 ? images.inverse_depth[i] : 0.0;
    const double x = scale[i] * inverse_depth * fx * gradients[0][i];
    const double y = scale[i] * inverse_depth * fy * gradients[1][i];
    const double away = images.in_camera[0][i] * x + images.in_camera[1][i] * y;
    (*by_image)[0][i] = x;
    (*by_image)[1][i] = y;
    (*by_image)[2][i] = inverse_depth != 0.0 ? -inverse_depth * away : 0.0;
  }
  for (int i = 0; i < kBatchSize; ++i) {
    const double x = (*by_image)[0][i], y = (*by_image)[1][i], z = (*by_image)[2][i];
    for (size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      (*by_image)[k][i] = rotation(0, axis) * x + rotation(1, axis) * y + rotation(2, axis) * z;
    }
  }
}

// Writes v . d(mirror image) / d landmark, all in the object frame: x is the intersection of the
// ray d with the surface, n the gradient there (n . x = 1). A change of the landmark moves x by k d
// along the ray, k (n . d) = n . dc + dw . (x x n) + sum_i x_i n_i dlog(s_i). The plane y = m
// mirrors x, and rotates and moves with the landmark.
SOSLAM_MULTIVERSION void ByBody(const RayBatch& rays, const BatchOfVectors& v, double m,
                                ResidualBatch* rows) {
  auto& [w_x, w_y, w_z, c_x, c_y, c_z, log_a, log_b, log_c] = rows->by_landmark;
  for (int i = 0; i < kBatchSize; ++i) {
    const double v_x = v[0][i], v_y = v[1][i], v_z = v[2][i];
    // A ray that misses the surface has no point and no derivative.
    const bool is_still = v_x == 0.0 && v_y == 0.0 && v_z == 0.0;
    const double x = is_still ? 0.0 : rays.point[0][i];
    const double y = is_still ? 0.0 : rays.point[1][i];
    const double z = is_still ? 0.0 : rays.point[2][i];
    const double n_x = is_still ? 0.0 : rays.gradient[0][i];
    const double n_y = is_still ? 0.0 : rays.gradient[1][i];
    const double n_z = is_still ? 0.0 : rays.gradient[2][i];
    const double d_x = rays.direction[0][i], d_y = rays.direction[1][i], d_z = rays.direction[2][i];
    const double quotient =
        (v_x * d_x - v_y * d_y + v_z * d_z) / (n_x * d_x + n_y * d_y + n_z * d_z);
    const double k = is_still ? 0.0 : quotient;
    const double across = 2.0 * (y - m);
    w_x[i] = k * (y * n_z - z * n_y) - 2.0 * v_y * z - across * v_z;
    w_y[i] = k * (z * n_x - x * n_z);
    w_z[i] = k * (x * n_y - y * n_x) + 2.0 * v_y * x + across * v_x;
    c_x[i] = k * n_x;
    c_y[i] = k * n_y + 2.0 * v_y;
    c_z[i] = k * n_z;
    // The offset of the mirror plane is proportional to the object's size.
    const double by_size = 2.0 / 3.0 * v_y * m;
    log_a[i] = k * x * n_x + by_size;
    log_b[i] = k * y * n_y + by_size;
    log_c[i] = k * z * n_z + by_size;
  }
}

void TurnToCamera(const Eigen::Matrix3d& rotation, Batch* vector) {
  const Batch x = vector[0], y = vector[1], z = vector[2];
  for (int k = 0; k < 3; ++k) {
    vector[k] = rotation(k, 0) * x + rotation(k, 1) * y + rotation(k, 2) * z;
  }
}

}  // namespace

// The pixels with respect to one landmark.
class MirrorResiduals::View {
 public:
  View(const MirrorResiduals& residuals, const Landmark& landmark_in_camera)
      : residuals_(residuals),
        body_(landmark_in_camera),
        place_(residuals.mirror_plane_ * std::cbrt(landmark_in_camera.half_axes.prod())) {}

  // A batch's residuals and, if asked for, their derivatives; otherwise the remaining rows are not
  // written.
  void Find(size_t batch, bool with_derivatives, ResidualBatch* rows) {
    const PixelRays& rays = residuals_.rays_;
    const size_t begin = batch * kBatchSize;
    body_.Meet(rays.x.data() + begin, rays.y.data() + begin, &rays_);
    Mirror(residuals_.camera_, body_, rays_.point, place_, &images_);
    BatchOfPixels gradients;
    const Batch mirrored =
        residuals_.unit_ *
        SampleBilinear(residuals_.map_, images_.pixels, with_derivatives ? &gradients : nullptr);
    const Batch difference =
        (rays_.depth > 0.0).select(residuals_.values_[batch] - mirrored, kNone);
    const double squared_scale = residuals_.scale_ * residuals_.scale_;
    const Batch inverse_norm = (difference.square() + squared_scale).sqrt().inverse();
    const auto is_pair = inverse_norm > 0.0;  // false for NaN
    const Batch& is_pixel = residuals_.is_pixel_[batch];
    rows->residual = is_pixel * is_pair.select(difference * inverse_norm, 1.0);
    if (!with_derivatives) return;
    const Batch slope =
        is_pixel * is_pair.select(-residuals_.unit_ * squared_scale * inverse_norm.cube(), 0.0);
    BatchOfVectors by_image;
    ByImage(residuals_.camera_, body_.rotation, images_, gradients, slope, &by_image);
    ByBody(rays_, by_image, place_, rows);
    TurnToCamera(body_.rotation, &rows->by_landmark[0]);
    TurnToCamera(body_.rotation, &rows->by_landmark[3]);
  }

 private:
  const MirrorResiduals& residuals_;
  BodyInCamera body_;
  double place_;  // offset of the mirror plane, m
  RayBatch rays_;
  MirrorImages images_;
};

MirrorResiduals::MirrorResiduals(const cv::Mat& map, double unit, const Camera& camera,
                                 const std::vector<Eigen::Vector2d>& pixels, double mirror_plane,
                                 double scale)
    : map_(map),
      unit_(unit),
      camera_(camera),
      mirror_plane_(mirror_plane),
      scale_(scale),
      rays_(camera, pixels) {
  for (size_t i = 0; i < pixels.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i % kBatchSize);
    if (place == 0) {
      values_.emplace_back(Batch::Zero());
      is_pixel_.emplace_back(Batch::Zero());
    }
    const auto sample = SampleBilinear(map, pixels[i]);
    values_.back()[place] = sample ? unit * sample->value : kNone;
    is_pixel_.back()[place] = 1.0;
  }
}

double MirrorResiduals::Value(const Landmark& landmark_in_camera) const {
  View view(*this, landmark_in_camera);
  double sum = 0.0;
  for (size_t batch = 0; batch < values_.size(); ++batch) {
    ResidualBatch rows;
    view.Find(batch, /*with_derivatives=*/false, &rows);
    sum += rows.residual.square().sum();
  }
  return 0.5 * sum;
}

void MirrorResiduals::AddTo(const Landmark& landmark_in_camera, double weight,
                            LandmarkModel* sum) const {
  View view(*this, landmark_in_camera);
  for (size_t batch = 0; batch < values_.size(); ++batch) {
    ResidualBatch rows;
    view.Find(batch, /*with_derivatives=*/true, &rows);
    rows.AddTo(weight, sum);
  }
}

}  // namespace soslam
