// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/training/furniture_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "soslam/geometry/angles.h"
#include "soslam/training/rasterise.h"

namespace soslam {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3f RandomColour(Random* random, double darkest, double brightest) {
  const double grey = random->Uniform(darkest, brightest);
  return static_cast<float>(grey) *
         (Eigen::Vector3f::Ones() + random->Normals(0.2)).cwiseMax(0.1f).cwiseMin(2.0f);
}

// Colours of a model, some or all of them others than its own.
std::vector<Material> RandomMaterials(const FurnitureModel& model, Random* random) {
  std::vector<Material> materials = model.materials;
  const bool is_recoloured = random->Chance(0.6);
  const bool is_plain = random->Chance(0.2);  // without textures
  const bool has_one_colour = random->Chance(0.2);
  const Eigen::Vector3f one_colour = RandomColour(random, 0.03, 0.8);
  for (Material& material : materials) {
    if (is_plain && !material.texture.empty()) {
      material.texture.release();
      material.colour = RandomColour(random, 0.05, 0.8);
    }
    if (is_recoloured && random->Chance(0.6)) {
      material.colour = material.texture.empty() ? RandomColour(random, 0.03, 0.85)
                                                 : RandomColour(random, 0.4, 1.2);
    }
    if (has_one_colour) material.colour = one_colour;
    material.colour = material.colour.cwiseMax(0.02f);
    material.gloss = random->Chance(0.5) ? 0.0f : static_cast<float>(random->Uniform(0.0, 0.3));
  }
  return materials;
}

// The pattern of a floor or wall.
struct Pattern {
  enum class Kind { kPlain, kTiles, kPlanks, kTexture };
  Kind kind;
  Eigen::Vector3f colours[2];
  float scale;  // metres of a tile, of the width of a plank, or of a texture
  Eigen::Rotation2Df turn;
  cv::Mat texture;

  Eigen::Vector3f At(const Eigen::Vector2f& point) const {
    const Eigen::Vector2f p = turn * point / scale;
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
    if (kind == Kind::kPlain) return colours[0];
    if (kind == Kind::kTiles) return colours[(x + y) & 1];
    if (kind == Kind::kTexture) {
      const auto pixel = [](float part, int pixels) {
        return std::clamp(static_cast<int>(part * static_cast<float>(pixels)), 0, pixels - 1);
      };
      const cv::Vec3b& colour =
          texture.at<cv::Vec3b>(pixel(p.y() - static_cast<float>(y), texture.rows),
                                pixel(p.x() - static_cast<float>(x), texture.cols));
      return Eigen::Vector3f(colour[0], colour[1], colour[2]) / 255.0f;
    }
    const float shade = 0.5f + 0.5f * std::sin(37.0f * static_cast<float>(y));
    const float joint = p.y() - static_cast<float>(y) < 0.05f ? 0.6f : 1.0f;
    return joint * (shade * colours[0] + (1.0f - shade) * colours[1]);
  }
};

Pattern RandomPattern(const std::vector<const FurnitureModel*>& models, Random* random) {
  Pattern pattern{static_cast<Pattern::Kind>(random->Index(4)),
                  {RandomColour(random, 0.05, 0.95), {}},
                  static_cast<float>(std::exp(random->Uniform(std::log(0.05), std::log(1.5)))),
                  Eigen::Rotation2Df(static_cast<float>(random->Uniform(0.0, kPi))),
                  {}};
  pattern.colours[1] =
      pattern.colours[0].cwiseProduct(Eigen::Vector3f::Ones() + random->Normals(0.25)).cwiseMax(0);
  if (pattern.kind != Pattern::Kind::kTexture) return pattern;
  const FurnitureModel& model = *models[random->Index(models.size())];
  const Material& material = model.materials[random->Index(model.materials.size())];
  if (material.texture.empty()) {
    pattern.kind = Pattern::Kind::kPlain;
  } else {
    pattern.texture = material.texture;
  }
  return pattern;
}

// Floor and two walls behind the models.
void DrawRoom(const std::vector<const FurnitureModel*>& models, double size, const cv::Mat& shadow,
              double darkness, Random* random, Rasteriser* canvas) {
  struct Surface {
    Eigen::Vector3f normal;
    float offset;  // normal . point = offset
    Pattern pattern;
    float light;
  };
  std::vector<Surface> surfaces;
  surfaces.push_back({Eigen::Vector3f::UnitZ(), 0.0f, RandomPattern(models, random),
                      static_cast<float>(random->Uniform(0.5, 1.2))});
  const Eigen::Vector3f centre = canvas->CentreInWorld();
  const double behind = std::atan2(-centre.y(), -centre.x());
  for (const double side : {-0.7, 0.7}) {
    const double direction = behind + side + random->Normal(0.4);
    const Eigen::Vector3f outwards(static_cast<float>(std::cos(direction)),
                                   static_cast<float>(std::sin(direction)), 0.0f);
    surfaces.push_back({-outwards, -static_cast<float>(size * random->Uniform(0.6, 5.0)),
                        RandomPattern(models, random),
                        static_cast<float>(random->Uniform(0.5, 1.2))});
  }
  for (int v = 0; v < canvas->colour.rows; ++v) {
    for (int u = 0; u < canvas->colour.cols; ++u) {
      if (canvas->number.at<uchar>(v, u) != 0) continue;
      const Eigen::Vector3f ray = canvas->RayInWorld(u, v);
      float nearest = 1e3f;
      Eigen::Vector3f colour = Eigen::Vector3f::Constant(180.0f);
      for (const Surface& surface : surfaces) {
        const float approach = -surface.normal.dot(ray);
        const float depth = (surface.normal.dot(centre) - surface.offset) / approach;
        if (approach <= 0.0f || depth <= 0.0f || depth >= nearest) continue;
        nearest = depth;
        const Eigen::Vector3f point = centre + depth * ray;
        const bool is_floor = &surface == &surfaces.front();
        const Eigen::Vector2f in_surface =
            is_floor ? Eigen::Vector2f(point.head<2>())
                     : Eigen::Vector2f(point.dot(Eigen::Vector3f::UnitZ().cross(surface.normal)),
                                       point.z());
        colour = 255.0f * surface.light * surface.pattern.At(in_surface);
        if (is_floor)
          colour *= 1.0f - static_cast<float>(darkness) * shadow.at<uchar>(v, u) / 255.0f;
      }
      canvas->colour.at<cv::Vec3f>(v, u) = {colour.x(), colour.y(), colour.z()};
    }
  }
}

// A camera at a distance from the origin that looks at a point near it.
Rigid3d CameraFromWorld(double azimuth, double elevation, double distance, double roll,
                        const Eigen::Vector3d& target) {
  const Eigen::Vector3d centre =
      target + distance * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                          std::cos(elevation) * std::sin(azimuth),
                                          std::sin(elevation));
  Eigen::Matrix3d rotation;
  rotation.row(2) = (target - centre).normalized();
  rotation.row(0) = rotation.row(2).cross(Eigen::Vector3d::UnitZ()).normalized();
  rotation.row(1) = rotation.row(2).cross(rotation.row(0));
  const Eigen::Quaterniond camera_from_world(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
                                             rotation);
  return {camera_from_world, -(camera_from_world * centre)};
}

Camera SquareCamera(int width, double focal_px) {
  const double middle = 0.5 * (width - 1);
  return {width, width, focal_px, focal_px, middle, middle};
}

// A camera, with its pose, that sees a target of this size in the world of the target, whose front
// is the x axis.
std::pair<Camera, Rigid3d> RandomCamera(const Eigen::Vector3d& size, Random* look, Random* random) {
  constexpr double kArc = 25.0 / kDegPerRad;
  const double diagonal = size.norm();
  const double azimuth = look->Uniform(-kPi, kPi) + random->Uniform(-kArc, kArc);
  const double elevation = look->Uniform(-5.0, 48.0) / kDegPerRad;
  const double distance = diagonal * look->Uniform(1.1, 5.0);
  const double pixels = std::exp(random->Uniform(std::log(45.0), std::log(280.0)));
  const Eigen::Vector3d aim = Eigen::Vector3d(0.0, 0.0, 0.5 * size.z()) +
                              0.1 * diagonal * random->Normals(1.0).cast<double>();
  return {SquareCamera(static_cast<int>(1.6 * pixels) + 16, pixels * distance / diagonal),
          CameraFromWorld(azimuth, elevation, distance, random->Normal(0.1), aim)};
}

constexpr int kOversampling = 2;

// The box of what is seen of the target, in pixels of the image without oversampling.
Box BoxOfTarget(const cv::Mat& numbers) {
  const cv::Rect outline = cv::boundingRect(numbers == 1);
  const auto to_pixel = [](int fine_edge) {
    return static_cast<double>(fine_edge) / kOversampling - 0.5;
  };
  return {to_pixel(outline.x), to_pixel(outline.y), to_pixel(outline.x + outline.width),
          to_pixel(outline.y + outline.height)};
}

Lighting RandomLighting(Random* random) {
  Lighting lighting;
  const size_t lights = 1 + random->Index(3);
  for (size_t i = 0; i < lights; ++i) {
    Eigen::Vector3f towards = random->Normals(1.0);
    towards.z() = std::abs(towards.z()) + 0.2f;
    lighting.lights.push_back(
        {towards.normalized(),
         static_cast<float>(random->Uniform(0.1, 0.8) / std::sqrt(static_cast<double>(lights))) *
             (Eigen::Vector3f::Ones() + random->Normals(0.08))});
  }
  lighting.from_above = RandomColour(random, 0.2, 0.6);
  lighting.from_below = static_cast<float>(random->Uniform(0.3, 0.9)) * lighting.from_above;
  return lighting;
}

// Exposure, and errors of lenses, sensors and files.
cv::Mat Photographed(const cv::Mat& colours, Random* random) {
  const cv::Scalar means = cv::mean(colours);
  const double mean = std::max((means[0] + means[1] + means[2]) / 3.0, 1.0);
  cv::Mat image = colours * (random->Uniform(70.0, 165.0) / mean);
  if (random->Chance(0.4)) cv::GaussianBlur(image, image, {}, random->Uniform(0.3, 1.3));
  if (random->Chance(0.3)) {
    cv::Mat blurred;
    cv::GaussianBlur(image, blurred, {}, 1.0);
    const double strength = random->Uniform(0.3, 1.5);
    image = (1.0 + strength) * image - strength * blurred;
  }
  const double contrast = random->Uniform(0.6, 1.3), brightness = random->Uniform(-20.0, 20.0);
  const Eigen::Vector3f cast = Eigen::Vector3f::Ones() + random->Normals(0.06);
  const bool is_grey = random->Chance(0.1);
  const double noise = random->Uniform(0.0, 8.0);
  cv::Mat bytes(image.size(), CV_8UC3);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      cv::Vec3f colour = image.at<cv::Vec3f>(v, u);
      if (is_grey) colour = cv::Vec3f::all((colour[0] + colour[1] + colour[2]) / 3.0f);
      for (int c = 0; c < 3; ++c) {
        const double seen = ((colour[c] - 128.0) * contrast + 128.0 + brightness) * cast[c];
        bytes.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<uchar>(seen + random->Normal(noise));
      }
    }
  }
  if (random->Chance(0.5)) {
    std::vector<uchar> file;
    cv::imencode(".jpg", bytes, file,
                 {cv::IMWRITE_JPEG_QUALITY, static_cast<int>(random->Uniform(40.0, 95.0))});
    bytes = cv::imdecode(file, cv::IMREAD_COLOR);
  }
  return bytes;
}

Eigen::Affine3f Placed(const Eigen::Vector2d& position, double height, double yaw,
                       const Eigen::Vector3f& stretch) {
  return Eigen::Translation3f(static_cast<float>(position.x()), static_cast<float>(position.y()),
                              static_cast<float>(height)) *
         Eigen::AngleAxisf(static_cast<float>(yaw), Eigen::Vector3f::UnitZ()) *
         Eigen::Scaling(stretch);
}

Eigen::Vector3f RandomStretch(Random* random) { return random->Normals(0.08).array().exp(); }

// Draws and adds others that stand about a target of this size, some between it and the camera.
void DrawOthers(const std::vector<const FurnitureModel*>& others, const Eigen::Vector3d& size,
                const Lighting& lighting, Random* random, std::vector<PlacedModel>* placed,
                Rasteriser* canvas) {
  const double diagonal = size.norm();
  const size_t count = random->Index(6);
  const Eigen::Vector3d camera_centre = canvas->CentreInWorld().cast<double>();
  for (size_t i = 0; i < count; ++i) {
    const FurnitureModel& other = *others[random->Index(others.size())];
    const double own_size = other.size.cast<double>().norm();
    if (own_size > 3.0 * diagonal || own_size < 0.15 * diagonal) continue;
    const bool is_in_front = random->Chance(0.35);
    const double towards = std::atan2(camera_centre.y(), camera_centre.x());
    const double direction =
        is_in_front ? towards + random->Normal(0.5) : random->Uniform(-kPi, kPi);
    const double away = random->Uniform(0.25, 0.6) * (own_size + diagonal) *
                        (is_in_front ? 1.0 : random->Uniform(1.0, 2.5));
    const Eigen::Vector2d position =
        away * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    if ((position - camera_centre.head<2>()).norm() < 0.7 * own_size) continue;
    const double height = random->Chance(0.25) ? random->Uniform(0.0, size.z()) : 0.0;
    const Eigen::Vector3f stretch = RandomStretch(random);
    placed->push_back({&other, Placed(position, height, random->Uniform(-kPi, kPi), stretch),
                       RandomMaterials(other, random)});
    canvas->Draw(placed->back(), lighting, 2);
  }
}

// The part of an image whose border cuts the box; camera and box become those of the part.
cv::Rect CutByBorder(Random* random, Camera* camera, Box* box) {
  const int width = camera->width, height = camera->height;
  const double cut = random->Uniform(-0.1, 0.35);
  const int left = static_cast<int>(box->x_min + cut * box->Width());
  const int top = static_cast<int>(box->y_min + cut * box->Height());
  const int right = static_cast<int>(box->x_max - cut * box->Width());
  const int bottom = static_cast<int>(box->y_max - cut * box->Height());
  const cv::Rect parts[] = {{left, 0, width - left, height},
                            {0, top, width, height - top},
                            {0, 0, right, height},
                            {0, 0, width, bottom}};
  const cv::Rect part = parts[random->Index(4)] & cv::Rect(0, 0, width, height);
  camera->cx -= part.x;
  camera->cy -= part.y;
  camera->width = part.width;
  camera->height = part.height;
  *box = {std::max(box->x_min - part.x, -0.5), std::max(box->y_min - part.y, -0.5),
          std::min(box->x_max - part.x, part.width - 0.5),
          std::min(box->y_max - part.y, part.height - 0.5)};
  return part;
}

}  // namespace

std::optional<FurnitureView> RandomView(const FurnitureModel& target,
                                        const std::vector<const FurnitureModel*>& others, int side,
                                        Random look, Random* random) {
  const Eigen::Vector3f stretch = RandomStretch(&look);
  const Eigen::Vector3d size = target.size.cwiseProduct(stretch).cast<double>();
  auto [camera, camera_from_world] = RandomCamera(size, &look, random);
  const int width = camera.width;
  Rasteriser canvas(SquareCamera(kOversampling * width, kOversampling * camera.fx),
                    camera_from_world);
  const Lighting lighting = RandomLighting(&look);
  std::vector<PlacedModel> placed;
  placed.push_back({&target, Placed({0, 0}, 0.0, 0.0, stretch), RandomMaterials(target, &look)});
  canvas.Draw(placed.front(), lighting, 1);
  const int all_pixels = cv::countNonZero(canvas.number == 1);
  DrawOthers(others, size, lighting, random, &placed, &canvas);
  const int visible_pixels = cv::countNonZero(canvas.number == 1);
  constexpr double kLeastVisible = 0.4;
  if (visible_pixels < kLeastVisible * all_pixels || all_pixels < 200) return std::nullopt;

  cv::Mat shadow(canvas.number.size(), CV_8U, cv::Scalar(0));
  for (const PlacedModel& model : placed) {
    canvas.DrawShadow(model, lighting.lights.front().towards_in_world, &shadow);
  }
  cv::GaussianBlur(shadow, shadow, {}, random->Uniform(0.5, 6.0));
  DrawRoom(others, size.norm(), shadow, random->Uniform(0.0, 0.7), random, &canvas);
  cv::Mat colours;
  cv::resize(canvas.colour, colours, {width, width}, 0, 0, cv::INTER_AREA);

  Box box = BoxOfTarget(canvas.number);
  cv::Rect part(0, 0, width, width);
  if (random->Chance(0.3)) part = CutByBorder(random, &camera, &box);
  if (box.Width() < 10.0 || box.Height() < 10.0) return std::nullopt;
  const double w = box.Width(), h = box.Height();
  constexpr double kBoxError = 0.035;  // of a side
  box.x_min += random->Normal(kBoxError) * w;
  box.x_max += random->Normal(kBoxError) * w;
  box.y_min += random->Normal(kBoxError) * h;
  box.y_max += random->Normal(kBoxError) * h;

  FurnitureView view;
  const Eigen::Vector3d up_in_camera =
      (camera_from_world.rotation * Eigen::Vector3d::UnitZ() + random->Normals(0.03).cast<double>())
          .normalized();
  view.crop =
      RenderCrop(Photographed(colours(part).clone(), random), camera, box, up_in_camera, side);
  const Eigen::Vector3d towards =
      -(camera_from_world.rotation.conjugate() * view.crop.direction.ray_in_camera);
  view.azimuth = std::atan2(towards.y(), towards.x());
  view.log_ratios = {std::log(size.x() / size.z()), std::log(size.y() / size.z())};
  view.visible_share = static_cast<double>(visible_pixels) / all_pixels;
  return view;
}

cv::Mat PlainView(const FurnitureModel& model, double azimuth, double elevation, int side) {
  const double diagonal = model.size.cast<double>().norm();
  const double distance = 3.0 * diagonal;
  Rasteriser canvas(
      SquareCamera(side, 0.8 * side * distance / diagonal),
      CameraFromWorld(azimuth, elevation, distance, 0.0, {0.0, 0.0, 0.5 * model.size.z()}));
  canvas.colour.setTo(cv::Scalar::all(128.0));
  const Eigen::Vector3f towards =
      (canvas.CentreInWorld() - Eigen::Vector3f(0, 0, 0.5f * model.size.z())).normalized();
  const Eigen::Vector3f half = Eigen::Vector3f::Constant(0.5f);
  canvas.Draw({&model, Placed({0, 0}, 0.0, 0.0, Eigen::Vector3f::Ones()), model.materials},
              {{{towards, half}}, half, half}, 1);
  cv::Mat bytes, grey;
  canvas.colour.convertTo(bytes, CV_8U);
  cv::cvtColor(bytes, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace soslam
