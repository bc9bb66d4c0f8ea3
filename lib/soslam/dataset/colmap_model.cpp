// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/colmap_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/text_file.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/image_size.h"
#include "soslam/image/file_kind.h"

namespace soslam {
namespace {

// Camera model of COLMAP with the names of its parameters, in order. "f" is both focal lengths.
struct ColmapCameraModel {
  int id;  // in binary files
  const char* name;
  std::vector<const char*> parameters;  // none where OpenCV's lens model does not include it
};

const std::vector<ColmapCameraModel> kModels = {
    {0, "SIMPLE_PINHOLE", {"f", "cx", "cy"}},
    {1, "PINHOLE", {"fx", "fy", "cx", "cy"}},
    {2, "SIMPLE_RADIAL", {"f", "cx", "cy", "k1"}},
    {3, "RADIAL", {"f", "cx", "cy", "k1", "k2"}},
    {4, "OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"}},
    {5, "OPENCV_FISHEYE", {}},
    {6, "FULL_OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}},
    {7, "FOV", {}},
    {8, "SIMPLE_RADIAL_FISHEYE", {}},
    {9, "RADIAL_FISHEYE", {}},
    {10, "THIN_PRISM_FISHEYE", {}},
    {11, "RAD_TAN_THIN_PRISM_FISHEYE", {}}};

using FoundModel = std::vector<ColmapCameraModel>::const_iterator;

// Throws InputError, naming `place`, for a model that OpenCV's lens model does not include; `other`
// stands for one that is not among kModels.
const ColmapCameraModel& SupportedModel(FoundModel found, const std::string& other,
                                        const std::string& place) {
  if (found != kModels.end() && !found->parameters.empty()) return *found;
  std::vector<std::string> names;
  for (const ColmapCameraModel& model : kModels) {
    if (!model.parameters.empty()) names.emplace_back(model.name);
  }
  throw InputError(fmt::format(
      "{}: camera model {} is not supported; expected one of {}; undistort the images first: "
      "colmap image_undistorter writes them with a model of PINHOLE cameras",
      place, found == kModels.end() ? other : fmt::format("'{}'", found->name),
      fmt::join(names, ", ")));
}

// The camera with these parameters, one per name. Throws InputError, naming `place`, for a size or
// a focal length that no camera has.
LensCamera CameraOfColmap(const ColmapCameraModel& model, std::int64_t width, std::int64_t height,
                          std::span<const double> parameters, const std::string& place) {
  const auto value = [&](std::string_view name) {
    const auto found = std::ranges::find(model.parameters, name);
    return found == model.parameters.end() ? 0.0 : parameters[found - model.parameters.begin()];
  };
  const double fx = value("f") + value("fx"), fy = value("f") + value("fy");
  if (!IsImageSize(width, height) || !(fx > 0.0) || !(fy > 0.0)) {
    throw InputError(place + ": expected width, height and focal length above 0");
  }
  LensCamera read;
  read.camera = {static_cast<int>(width), static_cast<int>(height), fx, fy,
                 value("cx") - 0.5,       value("cy") - 0.5};
  const Distortion lens{value("k1"), value("k2"), value("p1"), value("p2"),
                        value("k3"), value("k4"), value("k5"), value("k6")};
  if (lens != Distortion()) read.distortion = lens;
  return read;
}

// The pose of an image from the numbers QW QX QY QZ TX TY TZ of camera_from_world. Throws
// InputError, naming `place`, for a quaternion that is not of unit length.
NamedPose PoseOfColmapImage(const std::array<double, 7>& v, std::string name,
                            const std::string& place) {
  const Rigid3d camera_from_world{UnitQuaternion({v[1], v[2], v[3], v[0]}, place),
                                  {v[4], v[5], v[6]}};
  return {place, std::move(name), camera_from_world.Inverse()};
}

// The grey value that OpenCV gives to a colour.
double ConvertToGrey(const Eigen::Vector3d& rgb) {
  return rgb.dot(Eigen::Vector3d(0.299, 0.587, 0.114));
}

static_assert(std::endian::native == std::endian::little);

// The bytes of a file, taken from its beginning on.
class BinaryReader {
 public:
  explicit BinaryReader(const std::filesystem::path& path)
      : path_(path.string()), bytes_(ReadWholeFile(path, "binary file of COLMAP")) {}

  template <typename Number>
  Number Take() {
    Require(sizeof(Number));
    Number number;
    std::memcpy(&number, bytes_.data() + at_, sizeof(Number));
    at_ += sizeof(Number);
    return number;
  }

  double TakeReal(const std::string& place) {
    const auto number = Take<double>();
    if (!std::isfinite(number)) {
      throw InputError(fmt::format("{}: has the number {}; expected finite ones", place, number));
    }
    return number;
  }

  // A number of entries that have at least so many bytes each.
  size_t TakeCount(size_t bytes_each, const std::string& what) {
    const auto count = Take<std::uint64_t>();
    if (count > (bytes_.size() - at_) / bytes_each) {
      if (const std::string kind = FileKind(bytes_); !kind.empty()) {
        throw InputError(fmt::format("{}: is {}; expected a binary file of COLMAP", path_, kind));
      }
      throw InputError(
          fmt::format("{}: byte {}: says {} {}; expected no more than its {} bytes can "
                      "hold: the file is cut short or damaged",
                      path_, at_, count, what, bytes_.size()));
    }
    return static_cast<size_t>(count);
  }

  // The text up to the next zero byte.
  std::string TakeText() {
    const size_t end = bytes_.find('\0', at_);
    if (end == bytes_.npos) Require(bytes_.size());
    std::string text = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }

  void RequireEnd() const {
    if (at_ == bytes_.size()) return;
    throw InputError(fmt::format("{}: has {} bytes after its last entry; expected none", path_,
                                 bytes_.size() - at_));
  }

 private:
  void Require(size_t count) const {
    if (bytes_.size() - at_ >= count) return;
    throw InputError(fmt::format("{}: ends within an entry, at byte {}; expected a whole file",
                                 path_, bytes_.size()));
  }

  std::string path_;
  std::string bytes_;
  size_t at_ = 0;
};

struct ColmapCamera {
  std::int64_t id = 0;
  PlacedCamera placed;
};

ColmapCamera TakeCamera(BinaryReader* reader, const std::string& place) {
  const auto camera_id = reader->Take<std::uint32_t>();
  const auto id = reader->Take<std::int32_t>();
  const ColmapCameraModel& model = SupportedModel(
      std::ranges::find(kModels, id, &ColmapCameraModel::id), std::to_string(id), place);
  const auto width = reader->Take<std::int64_t>(), height = reader->Take<std::int64_t>();
  std::vector<double> parameters(model.parameters.size());
  for (double& value : parameters) value = reader->TakeReal(place);
  return {camera_id, {place, CameraOfColmap(model, width, height, parameters, place)}};
}

ColmapImage TakeImage(BinaryReader* reader, const std::string& place) {
  constexpr size_t kBytesOfPixel = 24;
  ColmapImage image;
  image.id = reader->Take<std::uint32_t>();
  std::array<double, 7> numbers;
  for (double& value : numbers) value = reader->TakeReal(place);
  image.camera_id = reader->Take<std::uint32_t>();
  image.pose = PoseOfColmapImage(numbers, reader->TakeText(), place);
  const size_t count = reader->TakeCount(kBytesOfPixel, "image points");
  image.pixels.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const double x = reader->TakeReal(place), y = reader->TakeReal(place);
    reader->Take<std::uint64_t>();  // id of its point; the points list their image points
    image.pixels.emplace_back(x - 0.5, y - 0.5);
  }
  return image;
}

ColmapPoint TakePoint(BinaryReader* reader, const std::string& place) {
  constexpr size_t kBytesOfObservation = 8;
  ColmapPoint point;
  point.id = reader->Take<std::uint64_t>();
  for (double& value : point.position_in_world) value = reader->TakeReal(place);
  Eigen::Vector3d rgb;
  for (double& value : rgb) value = reader->Take<std::uint8_t>();
  point.grey = ConvertToGrey(rgb);
  point.reprojection_error_px = reader->TakeReal(place);
  const size_t count = reader->TakeCount(kBytesOfObservation, "observations");
  point.track.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const auto image = reader->Take<std::uint32_t>();
    point.track.push_back({image, reader->Take<std::uint32_t>()});
  }
  return point;
}

// The entries of a binary file, of `least_bytes` each at least: "camera", "image" or "point".
template <typename Entry>
std::vector<Entry> ReadBinary(const std::filesystem::path& path, const std::string& name,
                              size_t least_bytes,
                              Entry (*take)(BinaryReader*, const std::string& place)) {
  BinaryReader reader(path);
  const size_t count = reader.TakeCount(least_bytes, name + "s");
  std::vector<Entry> entries;
  for (size_t i = 0; i < count; ++i) {
    entries.push_back(take(&reader, fmt::format("{}: {} {}", path.string(), name, i + 1)));
  }
  reader.RequireEnd();
  return entries;
}

bool IsBinary(const std::filesystem::path& path) { return path.extension() == ".bin"; }

ColmapCamera ParseColmapCamera(const TextLine& line) {
  const auto words = SplitWords(line.text);
  if (words.size() < 4) {
    throw InputError(line.place + ": expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]");
  }
  const ColmapCameraModel& model =
      SupportedModel(std::ranges::find(kModels, words[1], &ColmapCameraModel::name),
                     fmt::format("'{}'", words[1]), line.place);
  if (words.size() != 4 + model.parameters.size()) {
    throw InputError(fmt::format("{}: has {} parameters; expected {} of {}", line.place,
                                 words.size() - 4, model.parameters.size(), model.name));
  }
  std::vector<double> values;
  for (size_t i = 4; i < words.size(); ++i) {
    values.push_back(ParseReal(words[i], line.place, model.parameters[i - 4]));
  }
  return {ParseInteger(words[0], line.place, "CAMERA_ID"),
          {line.place,
           CameraOfColmap(model, ParseInteger(words[2], line.place, "width"),
                          ParseInteger(words[3], line.place, "height"), values, line.place)}};
}

// One line of an image, without its image points.
ColmapImage ParseImage(const TextLine& line) {
  constexpr std::array kFields = {"QW", "QX", "QY", "QZ", "TX", "TY", "TZ"};
  const auto words = SplitWords(line.text);
  if (words.size() < 10) {
    throw InputError(
        fmt::format("{}: has {} words; expected IMAGE_ID QW QX QY QZ TX TY TZ "
                    "CAMERA_ID NAME, and a line of points below it",
                    line.place, words.size()));
  }
  const auto numbers = ParseReals(std::span(words).subspan(1), line.place, kFields);
  ColmapImage image;
  image.id = ParseInteger(words[0], line.place, "IMAGE_ID");
  image.camera_id = ParseInteger(words[8], line.place, "CAMERA_ID");
  // The name may contain blanks: it is the rest of the line.
  const auto name = static_cast<size_t>(words[9].data() - line.text.data());
  image.pose = PoseOfColmapImage(numbers, line.text.substr(name), line.place);
  return image;
}

// Some programs write no line of image points. The next line is then that of an image, of a number
// of words that image points do not have.
std::vector<ColmapImage> ReadImagesText(const std::filesystem::path& path) {
  constexpr size_t kWordsOfImage = 10;
  std::vector<ColmapImage> images;
  size_t without_line = 0;
  bool is_points = false;
  for (const TextLine& line : RawLines(ReadWholeFile(path), path.string())) {
    const std::string_view text = Trimmed(line.text);
    if (!is_points && (text.empty() || text.front() == '#')) continue;
    if (is_points && SplitWords(text).size() == kWordsOfImage) {
      ++without_line;
      is_points = false;
    }
    if (!is_points) {
      images.push_back(ParseImage({line.place, std::string(text)}));
      is_points = true;
      continue;
    }
    is_points = false;
    const auto words = SplitWords(line.text);
    if (words.size() % 3 != 0) {
      throw InputError(
          fmt::format("{}: has {} words; expected X Y POINT3D_ID of each image point, or "
                      "an empty line for an image without",
                      line.place, words.size()));
    }
    for (size_t i = 0; i < words.size(); i += 3) {
      images.back().pixels.emplace_back(ParseReal(words[i], line.place, "X") - 0.5,
                                        ParseReal(words[i + 1], line.place, "Y") - 0.5);
    }
  }
  if (without_line > 0) {
    fmt::print(
        "{}: {} of {} images have no line of image points below them; their poses are read\n",
        path.string(), without_line + (is_points ? 1 : 0), images.size());
  }
  return images;
}

std::vector<ColmapCamera> ReadCameras(const std::filesystem::path& path) {
  auto cameras = IsBinary(path) ? ReadBinary(path, "camera", /*least_bytes=*/24, &TakeCamera)
                                : ParseTextLines(path, &ParseColmapCamera);
  if (!cameras.empty()) return cameras;
  throw InputError(path.string() + ": has no camera; expected COLMAP's cameras.txt or cameras.bin");
}

// The one camera of the images; of all cameras if there are no images. Cameras of no image do not
// matter.
LensCamera FindCamera(const std::vector<ColmapImage>& images,
                      const std::vector<ColmapCamera>& cameras, std::vector<Finding>* findings) {
  std::map<std::int64_t, const PlacedCamera*> by_id;
  for (const ColmapCamera& camera : cameras) by_id[camera.id] = &camera.placed;
  std::vector<PlacedCamera> used;
  for (const ColmapImage& image : images) {
    const auto camera = by_id.find(image.camera_id);
    if (camera == by_id.end()) {
      throw InputError(fmt::format(
          "{}: has camera {}, which the cameras do not have; expected files of one model",
          image.pose.place, image.camera_id));
    }
    used.push_back(*camera->second);
  }
  if (images.empty()) {
    for (const ColmapCamera& camera : cameras) used.push_back(camera.placed);
  }
  return OneCamera(used, "COLMAP's --ImageReader.single_camera 1", findings);
}

std::vector<ColmapImage> ReadImages(const std::filesystem::path& path) {
  auto images = IsBinary(path) ? ReadBinary(path, "image", /*least_bytes=*/73, &TakeImage)
                               : ReadImagesText(path);
  if (images.empty()) {
    throw InputError(path.string() + ": has no pose; expected COLMAP's images.txt or images.bin");
  }
  return images;
}

ColmapPoint ParsePoint(const TextLine& line) {
  constexpr size_t kTrack = 8;
  const auto words = SplitWords(line.text);
  if (words.size() < kTrack || words.size() % 2 != 0) {
    throw InputError(fmt::format(
        "{}: has {} words; expected POINT3D_ID X Y Z R G B ERROR, then IMAGE_ID POINT2D_IDX of "
        "each observation",
        line.place, words.size()));
  }
  ColmapPoint point;
  const int id = ParseInteger(words[0], line.place, "POINT3D_ID");
  if (id < 0)
    throw InputError(fmt::format("{}: POINT3D_ID is {}; expected 0 or more", line.place, id));
  point.id = static_cast<std::uint64_t>(id);
  for (size_t i = 0; i < 3; ++i) {
    point.position_in_world[static_cast<int>(i)] = ParseReal(words[i + 1], line.place, "XYZ");
  }
  point.grey =
      ConvertToGrey({ParseReal(words[4], line.place, "R"), ParseReal(words[5], line.place, "G"),
                     ParseReal(words[6], line.place, "B")});
  point.reprojection_error_px = ParseReal(words[7], line.place, "ERROR");
  for (size_t i = kTrack; i < words.size(); i += 2) {
    point.track.push_back({ParseInteger(words[i], line.place, "IMAGE_ID"),
                           ParseInteger(words[i + 1], line.place, "POINT2D_IDX")});
  }
  return point;
}

// Throws InputError unless ids are unique, and image points of tracks exist where their images have
// any. Leaves out observations in images that have none, or that the model does not have.
void CheckTracks(ColmapModel* model) {
  std::map<std::int64_t, std::int64_t> pixels_of_image;
  for (const ColmapImage& image : model->images) {
    if (!pixels_of_image.emplace(image.id, image.pixels.size()).second) {
      throw InputError(fmt::format("{}: is the second image with id {}; expected one",
                                   image.pose.place, image.id));
    }
  }
  const std::string file = model->files.back().string();
  size_t all = 0, left_out = 0;
  for (size_t i = 0; i < model->points.size(); ++i) {
    ColmapPoint& point = model->points[i];
    if (i > 0 && point.id == model->points[i - 1].id) {
      throw InputError(fmt::format("{}: has two points with id {}; expected one", file, point.id));
    }
    all += point.track.size();
    left_out += std::erase_if(point.track, [&](const ColmapPoint::Observation& observation) {
      const auto image = pixels_of_image.find(observation.image_id);
      if (image == pixels_of_image.end() || image->second == 0) return true;
      if (observation.pixel_index >= 0 && observation.pixel_index < image->second) return false;
      throw InputError(fmt::format(
          "{}: point {}: is seen at image point {} of image {}, which has "
          "{}; expected files of one model",
          file, point.id, observation.pixel_index, observation.image_id, image->second));
    });
  }
  if (left_out == 0) return;
  model->findings.push_back(
      {"tracks_without_images", Severity::kWarning,
       fmt::format("{}: {} of {} observations of points are in images that the model does not "
                   "have, or has without image points; they are left out",
                   file, left_out, all),
       "images, with their image points, for all observations",
       "images that were taken out of the model, or lines of image points that were left empty",
       "nothing where enough points are left; otherwise the whole model"});
}

}  // namespace

LensCamera ReadColmapCamera(const std::filesystem::path& path, std::vector<Finding>* findings) {
  const std::vector<ColmapCamera> cameras = ReadCameras(path);
  const std::filesystem::path images = path.parent_path() / ("images" + path.extension().string());
  const bool has_images = cameras.size() > 1 && IsFile(images);
  return FindCamera(has_images ? ReadImages(images) : std::vector<ColmapImage>(), cameras,
                    findings);
}

std::vector<NamedPose> ReadColmapPoses(const std::filesystem::path& path) {
  std::vector<NamedPose> poses;
  for (ColmapImage& image : ReadImages(path)) poses.push_back(std::move(image.pose));
  return poses;
}

std::vector<ColmapPoint> ReadColmapPoints(const std::filesystem::path& path) {
  if (IsBinary(path)) return ReadBinary(path, "point", /*least_bytes=*/51, &TakePoint);
  return ParseTextLines(path, &ParsePoint);
}

bool IsColmapModel(const std::filesystem::path& folder) {
  return IsFile(folder / "cameras.bin") || IsFile(folder / "cameras.txt");
}

ColmapModel ReadColmapModel(const std::filesystem::path& folder) {
  const std::string extension = IsFile(folder / "cameras.bin") ? ".bin" : ".txt";
  ColmapModel model;
  for (const char* name : {"cameras", "images", "points3D"}) {
    model.files.push_back(folder / (name + extension));
  }
  if (!IsFile(model.files.back())) model.files.pop_back();
  model.images = ReadImages(model.files[1]);
  model.camera = FindCamera(model.images, ReadCameras(model.files[0]), &model.findings);
  if (model.files.size() > 2) model.points = ReadColmapPoints(model.files[2]);
  std::ranges::sort(model.points, {}, &ColmapPoint::id);
  CheckTracks(&model);
  return model;
}

ColmapCameraText ToColmap(const LensCamera& camera) {
  const Camera& c = camera.camera;
  std::vector<double> values = {c.fx, c.fy, c.cx + 0.5, c.cy + 0.5};
  if (!camera.distortion) return {"PINHOLE", fmt::format("{}", fmt::join(values, ","))};
  const std::vector<double> lens = DistortionCoefficients(*camera.distortion);
  if (lens.size() > 8) {
    throw InputError(
        "distortion: has thin prisms or a tilted sensor; expected a lens that COLMAP "
        "has a model of: at most k1 k2 p1 p2 k3 k4 k5 k6");
  }
  const bool is_short = std::all_of(lens.begin() + 4, lens.end(), [](double k) { return k == 0; });
  values.insert(values.end(), lens.begin(), lens.end());
  values.resize(is_short ? 8 : 12);
  return {is_short ? "OPENCV" : "FULL_OPENCV", fmt::format("{}", fmt::join(values, ","))};
}

}  // namespace soslam
