// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/check_input.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "soslam/base/error.h"

namespace soslam {
namespace {

constexpr double kNormTolerance = 1e-6;

void Require(bool holds, const std::string& row, const std::string& found_and_expected) {
  if (!holds) throw InputError(row + ": " + found_and_expected);
}

void RequireOnePerObject(const Sequence& sequence, size_t size, const char* list) {
  Require(
      size == sequence.objects.size(), list,
      fmt::format("has {} entries; expected {}, one per object", size, sequence.objects.size()));
}

std::string NameObject(const Sequence& sequence, size_t object_index) {
  return fmt::format("object {}, \"{}\"", object_index, sequence.objects[object_index].label);
}

void RequireIndex(int index, size_t size, const std::string& row, const char* name) {
  Require(index >= 0 && static_cast<size_t>(index) < size, row,
          fmt::format("{} is {}; expected an index in a list of {}", name, index, size));
}

void RequireRigid(const Rigid3d& rigid, const std::string& row, const char* name) {
  Require(rigid.translation.allFinite() &&
              std::abs(rigid.rotation.norm() - 1.0) < kNormTolerance,  // false for NaN
          row,
          fmt::format("{} has a rotation of norm {} or is not finite; expected a rigid motion",
                      name, rigid.rotation.norm()));
}

void RequireExponents(const ShapeExponents& exponents, const std::string& row) {
  for (const double exponent : {exponents.horizontal, exponents.vertical}) {
    Require(exponent >= 1.0 && exponent <= 2.0, row,
            fmt::format("a shape exponent is {}; expected 1 (cuboid) to 2 (ellipsoid)", exponent));
  }
}

}  // namespace

void CheckBackEndInput(const BackEndInput& input, const OptimiseOptions& options) {
  const Sequence& sequence = input.sequence;
  const size_t objects = sequence.objects.size();
  RequireOnePerObject(sequence, input.priors.size(), "priors");
  if (!input.points.empty()) RequireOnePerObject(sequence, input.points.size(), "points");
  if (!input.images_weighed_at.empty()) {
    RequireOnePerObject(sequence, input.images_weighed_at.size(), "images_weighed_at");
  }
  for (const SupportPlane& plane : sequence.planes) {
    Require(std::abs(plane.plane_in_world.normal.norm() - 1.0) < kNormTolerance &&
                std::isfinite(plane.plane_in_world.offset),
            fmt::format("plane {}", plane.id),
            "has a normal of another norm than 1, or no finite offset; expected a plane");
  }
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const std::string row = fmt::format("frame {}", i);
    RequireRigid(sequence.frames[i].world_from_camera, row, "world_from_camera");
    const Camera& camera = sequence.CameraOf(sequence.frames[i]);
    Require(camera.fx > 0.0 && camera.fy > 0.0 && std::isfinite(camera.cx + camera.cy) &&
                camera.width > 0 && camera.height > 0,
            row, "has a camera without a focal length, centre or size; expected all of them");
  }
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    const std::string row = fmt::format("detection {}", i);
    RequireIndex(detection.frame_index, sequence.frames.size(), row, "frame_index");
    RequireIndex(detection.object_index, objects, row, "object_index");
    const Box& box = detection.box;
    Require(box.Width() >= 0.0 && box.Height() >= 0.0 && std::isfinite(box.Width() * box.Height()),
            row, "has a box whose corners are not in order, or not finite");
    const Object& object = sequence.ObjectOf(detection);
    if (options.support && object.is_static) {
      RequireIndex(object.plane_index, sequence.planes.size(),
                   NameObject(sequence, detection.object_index),
                   "plane_index (without a plane, support has to be false)");
    }
  }
  for (size_t i = 0; i < objects; ++i) {
    const std::string row = NameObject(sequence, i);
    if (const auto& prior = input.priors[i]) {
      RequireExponents(prior->shape_exponents, row);
      Require((prior->ratio.array() > 0.0).all() && (prior->log_sigma.array() > 0.0).all() &&
                  prior->ratio.allFinite() && prior->log_sigma.allFinite(),
              row, "has a prior with a ratio or log_sigma that is not positive; expected positive");
    }
  }
  for (const auto& [index, image] : input.images) {
    RequireIndex(index, sequence.detections.size(), "images", "the index of a detection");
    Require(image != nullptr, "images", fmt::format("that of detection {} is null", index));
  }
}

void CheckInitialLandmarks(const BackEndInput& input) {
  RequireOnePerObject(input.sequence, input.initial_landmarks.size(), "initial_landmarks");
  for (size_t i = 0; i < input.initial_landmarks.size(); ++i) {
    const auto& landmark = input.initial_landmarks[i];
    if (!landmark) continue;
    const std::string row = NameObject(input.sequence, i);
    RequireRigid(landmark->frame_from_object, row, "its initial landmark");
    RequireExponents(landmark->shape_exponents, row);
    Require((landmark->half_axes.array() > 0.0).all() && landmark->half_axes.allFinite(), row,
            "has an initial landmark with a half axis that is not positive; expected lengths");
  }
}

}  // namespace soslam
