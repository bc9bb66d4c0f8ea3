// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/colmap_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "dataset/text_file.h"
#include "dataset/trajectories.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

// Camera model with the names of its parameters, in order. "f" is both focal lengths.
struct ColmapModel {
  const char* name;
  std::vector<const char*> parameters;
};

const std::vector<ColmapModel>& Models() {
  static const std::vector<ColmapModel> models = {
      {"SIMPLE_PINHOLE", {"f", "cx", "cy"}},
      {"PINHOLE", {"fx", "fy", "cx", "cy"}},
      {"SIMPLE_RADIAL", {"f", "cx", "cy", "k1"}},
      {"RADIAL", {"f", "cx", "cy", "k1", "k2"}},
      {"OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"}},
      {"FULL_OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}}};
  return models;
}

// Parameters of one line, accessed by name.
class Parameters {
 public:
  Parameters(const ColmapModel& model, std::vector<double> values)
      : model_(model), values_(std::move(values)) {}

  double Of(const char* name) const {
    for (size_t i = 0; i < values_.size(); ++i) {
      if (std::string_view(model_.parameters[i]) == name) return values_[i];
    }
    return 0.0;
  }

 private:
  const ColmapModel& model_;
  std::vector<double> values_;
};

LensCamera ParseColmapCamera(const TextLine& line) {
  const auto words = SplitWords(line.text);
  if (words.size() < 4) {
    throw InputError(line.place + ": expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]");
  }
  const auto model = std::ranges::find(Models(), words[1], &ColmapModel::name);
  if (model == Models().end()) {
    ParseLens(std::string(words[1]), {}, line.place);
    throw InputError(fmt::format("{}: camera model '{}' is not supported", line.place, words[1]));
  }
  if (words.size() != 4 + model->parameters.size()) {
    throw InputError(fmt::format("{}: has {} parameters; expected {} of {}", line.place,
                                 words.size() - 4, model->parameters.size(), model->name));
  }
  std::vector<double> values;
  for (size_t i = 4; i < words.size(); ++i) {
    values.push_back(ParseReal(words[i], line.place, model->parameters[i - 4]));
  }
  const Parameters of(*model, values);
  const double fx = of.Of("f") + of.Of("fx"), fy = of.Of("f") + of.Of("fy");
  LensCamera read;
  read.camera = {ParseInteger(words[2], line.place, "width"),
                 ParseInteger(words[3], line.place, "height"),
                 fx,
                 fy,
                 of.Of("cx") - 0.5,
                 of.Of("cy") - 0.5};
  if (!IsImageSize(read.camera.width, read.camera.height) || !(fx > 0.0) || !(fy > 0.0)) {
    throw InputError(line.place + ": expected width, height and focal length above 0");
  }
  const Distortion lens{of.Of("k1"), of.Of("k2"), of.Of("p1"), of.Of("p2"),
                        of.Of("k3"), of.Of("k4"), of.Of("k5"), of.Of("k6")};
  if (lens != Distortion()) read.distortion = lens;
  return read;
}

NamedPose ParsePose(const TextLine& line) {
  constexpr std::array kFields = {"QW", "QX", "QY", "QZ", "TX", "TY", "TZ"};
  const auto words = SplitWords(line.text);
  if (words.size() < 10) {
    throw InputError(
        fmt::format("{}: has {} words; expected IMAGE_ID QW QX QY QZ TX TY TZ "
                    "CAMERA_ID NAME, and a line of points below it",
                    line.place, words.size()));
  }
  std::array<double, kFields.size()> v;
  for (size_t i = 0; i < v.size(); ++i) v[i] = ParseReal(words[i + 1], line.place, kFields[i]);
  ParseInteger(words[0], line.place, "IMAGE_ID");
  ParseInteger(words[8], line.place, "CAMERA_ID");
  const Rigid3d camera_from_world{UnitQuaternion({v[1], v[2], v[3], v[0]}, line.place),
                                  {v[4], v[5], v[6]}};
  // The name may contain blanks: it is the rest of the line.
  const auto name = static_cast<size_t>(words[9].data() - line.text.data());
  return {line.place, std::string(Trimmed(std::string_view(line.text).substr(name))),
          camera_from_world.Inverse()};
}

void RefuseBinary(const std::filesystem::path& path) {
  if (path.extension() != ".bin") return;
  throw InputError(path.string() +
                   ": is of a binary model of COLMAP; expected its text: colmap model_converter "
                   "--input_path FOLDER --output_path FOLDER --output_type TXT");
}

}  // namespace

LensCamera ReadColmapCamera(const std::filesystem::path& path) {
  RefuseBinary(path);
  std::optional<LensCamera> read;
  for (const TextLine& line : ReadTextLines(path)) {
    const LensCamera camera = ParseColmapCamera(line);
    if (read && (camera.camera != read->camera || camera.distortion != read->distortion)) {
      throw InputError(line.place +
                       ": is another camera than the first; expected one for all images "
                       "(COLMAP's --ImageReader.single_camera 1)");
    }
    read = camera;
  }
  if (!read) throw InputError(path.string() + ": has no camera; expected COLMAP's cameras.txt");
  return *read;
}

std::vector<NamedPose> ReadColmapPoses(const std::filesystem::path& path) {
  RefuseBinary(path);
  std::vector<NamedPose> poses;
  bool is_points = false;
  for (const TextLine& line : ReadRawLines(path)) {
    const std::string_view text = Trimmed(line.text);
    if (!is_points && (text.empty() || text.front() == '#')) continue;
    if (!is_points) poses.push_back(ParsePose({line.place, std::string(text)}));
    is_points = !is_points;
  }
  if (poses.empty())
    throw InputError(path.string() + ": has no pose; expected COLMAP's images.txt");
  return poses;
}

}  // namespace soslam
