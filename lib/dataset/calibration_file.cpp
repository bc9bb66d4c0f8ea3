// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>
#include <vector>

#include "base/error.h"
#include "dataset/nearest_rotation.h"
#include "dataset/text_file.h"
#include "dataset/xml_fields.h"
#include "dataset/yaml_fields.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

// In lower case, without underscores, and without what ORB-SLAM3 calls its first camera.
std::string PlainKey(const std::string& key) {
  std::string plain;
  for (const char c : key) {
    if (c != '_') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain.starts_with("camera1.") ? "camera." + plain.substr(8) : plain;
}

class CalibrationReader {
 public:
  CalibrationReader(const NamedFields& fields, std::string file) : file_(std::move(file)) {
    for (const auto& [key, values] : fields) fields_[PlainKey(key)] = values;
  }

  Calibration Read() const {
    const auto [fx, fy, cx, cy] = Intrinsics();
    const auto [width, height] = Size();
    Calibration read;
    read.camera.camera = {width, height, fx, fy, cx, cy};
    if (!(fx > 0.0) || !(fy > 0.0)) {
      Refuse(fmt::format("focal lengths are {} and {}; expected pixels above 0", fx, fy));
    }
    read.camera.distortion = Lens();
    if (const auto* matrix = Find({"tbs.data", "tbs"})) {
      read.body_from_camera = Motion(Numbers(*matrix, "T_BS", 16));
    }
    return read;
  }

 private:
  using Values = std::vector<std::string>;

  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", file_, what));
  }

  // The first of these fields that there is; null when none is.
  const Values* Find(std::initializer_list<const char*> keys) const {
    for (const char* key : keys) {
      const auto found = fields_.find(key);
      if (found != fields_.end()) return &found->second;
    }
    return nullptr;
  }

  std::vector<double> Numbers(const Values& values, const char* name) const {
    std::vector<double> numbers;
    for (const std::string& value : values) numbers.push_back(ParseReal(value, file_, name));
    return numbers;
  }
  std::vector<double> Numbers(const Values& values, const char* name, size_t count) const {
    if (values.size() == count) return Numbers(values, name);
    Refuse(fmt::format("{} has {} numbers; expected {}", name, values.size(), count));
  }

  double Number(const char* key) const {
    const Values* values = Find({key});
    if (values == nullptr) Refuse(fmt::format("{} is missing", key));
    return Numbers(*values, key, 1).front();
  }

  std::array<int, 2> Size() const {
    Values size;
    if (const Values* resolution = Find({"resolution", "imagesize", "imagesize.data"})) {
      size = *resolution;
    } else {
      for (const auto& keys :
           {std::initializer_list<const char*>{"imagewidth", "width", "camera.width"},
            {"imageheight", "height", "camera.height"}}) {
        if (const Values* side = Find(keys)) size.insert(size.end(), side->begin(), side->end());
      }
    }
    if (size.size() != 2) Refuse("has no image_width and image_height; expected both, in pixels");
    const int width = ParseInteger(size[0], file_, "image width");
    const int height = ParseInteger(size[1], file_, "image height");
    if (!IsImageSize(width, height)) {
      Refuse(fmt::format("image size is {} x {}; expected pixels", width, height));
    }
    return {width, height};
  }

  std::array<double, 4> Intrinsics() const {
    if (const Values* values = Find({"cameramatrix.data", "cameramatrix", "k.data", "k"})) {
      const std::vector<double> k = Numbers(*values, "camera matrix", 9);
      if (k[1] != 0.0) Refuse(fmt::format("camera matrix has skew {}; expected 0", k[1]));
      return {k[0], k[4], k[2], k[5]};
    }
    if (const Values* values = Find({"intrinsics"})) {
      const std::vector<double> k = Numbers(*values, "intrinsics", 4);
      return {k[0], k[1], k[2], k[3]};
    }
    if (Find({"camera.fx"}) != nullptr) {
      return {Number("camera.fx"), Number("camera.fy"), Number("camera.cx"), Number("camera.cy")};
    }
    Refuse("has no camera_matrix; expected that or intrinsics (fx, fy, cx, cy)");
  }

  std::vector<double> Coefficients() const {
    if (const Values* values =
            Find({"distortioncoefficients.data", "distortioncoefficients", "distortioncoeffs",
                  "distcoeffs.data", "distcoeffs", "d.data", "d"})) {
      return Numbers(*values, "distortion coefficients");
    }
    std::vector<double> coefficients;
    for (const char* key : {"camera.k1", "camera.k2", "camera.p1", "camera.p2", "camera.k3"}) {
      coefficients.push_back(Find({key}) == nullptr ? 0.0 : Number(key));
    }
    return coefficients;
  }

  std::optional<Distortion> Lens() const {
    const std::vector<double> coefficients = Coefficients();
    for (const char* key : {"cameramodel", "cameratype", "camera.type", "distortionmodel"}) {
      const Values* name = Find({key});
      if (name == nullptr) continue;
      const std::string model = fmt::format("{}", fmt::join(*name, " "));
      if (!model.empty()) ParseLens(model, coefficients, file_);
    }
    return ParseLens("pinhole", coefficients, file_);
  }

  // Of a 4 x 4 matrix by rows.
  Rigid3d Motion(const std::vector<double>& matrix) const {
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> motion(matrix.data());
    return {NearestRotation(motion.topLeftCorner<3, 3>(), file_), motion.topRightCorner<3, 1>()};
  }

  NamedFields fields_;
  std::string file_;
};

}  // namespace

Calibration ReadCalibration(const std::filesystem::path& path) {
  const NamedFields fields =
      path.extension() == ".xml" ? ReadXmlFields(path) : ReadYamlFields(path);
  return CalibrationReader(fields, path.string()).Read();
}

}  // namespace soslam
