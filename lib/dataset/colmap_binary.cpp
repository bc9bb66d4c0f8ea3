// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/colmap_binary.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "base/error.h"
#include "dataset/colmap_camera.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

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
  size_t TakeCount(size_t bytes_each, const char* what) {
    const auto count = Take<std::uint64_t>();
    if (count > (bytes_.size() - at_) / bytes_each) {
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

  std::string Place(const char* entry, size_t index) const {
    return fmt::format("{}: {} {}", path_, entry, index + 1);
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

ColmapImage TakeImage(BinaryReader* reader, const std::string& place) {
  constexpr size_t kBytesOfPixel = 24;
  ColmapImage image;
  image.id = reader->Take<std::uint32_t>();
  double q[4], t[3];
  for (double& value : q) value = reader->TakeReal(place);
  for (double& value : t) value = reader->TakeReal(place);
  reader->Take<std::uint32_t>();  // id of its camera; all are the same
  const std::string name = reader->TakeText();
  image.pose = PoseOfColmapImage({q[1], q[2], q[3], q[0]}, {t[0], t[1], t[2]}, name, place);
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
  for (int i = 0; i < 3; ++i) reader->Take<std::uint8_t>();  // colour
  point.reprojection_error_px = reader->TakeReal(place);
  const size_t count = reader->TakeCount(kBytesOfObservation, "observations");
  point.track.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    const auto image = reader->Take<std::uint32_t>();
    point.track.push_back({image, reader->Take<std::uint32_t>()});
  }
  return point;
}

}  // namespace

std::vector<LensCamera> ReadColmapCamerasBinary(const std::filesystem::path& path) {
  constexpr size_t kLeastBytes = 24;
  BinaryReader reader(path);
  const size_t count = reader.TakeCount(kLeastBytes, "cameras");
  std::vector<LensCamera> cameras;
  for (size_t i = 0; i < count; ++i) {
    const std::string place = reader.Place("camera", i);
    reader.Take<std::uint32_t>();  // id
    const ColmapCameraModel& model = FindColmapCameraModel(reader.Take<std::int32_t>(), place);
    const auto width = reader.Take<std::int64_t>(), height = reader.Take<std::int64_t>();
    std::vector<double> parameters(model.parameters.size());
    for (double& value : parameters) value = reader.TakeReal(place);
    cameras.push_back(CameraOfColmap(model, width, height, parameters, place));
  }
  reader.RequireEnd();
  return cameras;
}

std::vector<ColmapImage> ReadColmapImagesBinary(const std::filesystem::path& path) {
  constexpr size_t kLeastBytes = 73;
  BinaryReader reader(path);
  const size_t count = reader.TakeCount(kLeastBytes, "images");
  std::vector<ColmapImage> images;
  for (size_t i = 0; i < count; ++i) images.push_back(TakeImage(&reader, reader.Place("image", i)));
  reader.RequireEnd();
  return images;
}

std::vector<ColmapPoint> ReadColmapPointsBinary(const std::filesystem::path& path) {
  constexpr size_t kLeastBytes = 51;
  BinaryReader reader(path);
  const size_t count = reader.TakeCount(kLeastBytes, "points");
  std::vector<ColmapPoint> points;
  points.reserve(count);
  for (size_t i = 0; i < count; ++i) points.push_back(TakePoint(&reader, reader.Place("point", i)));
  reader.RequireEnd();
  return points;
}

}  // namespace soslam
