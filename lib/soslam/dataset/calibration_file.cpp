// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <set>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/nerfstudio.h"
#include "soslam/dataset/text_file.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/dataset/yaml_fields.h"
#include "soslam/geometry/image_size.h"

namespace soslam {
namespace {

// Possible numbers of coefficients of OpenCV's model, and its names with them.
const std::map<std::vector<size_t>, std::set<std::string>> kLensModels = {
    {{0, 4, 5}, {"none", "simplepinhole"}},  // none: all of them 0
    {{0, 4, 5, 8, 12, 14}, {"pinhole", "perspective"}},
    {{4, 5, 8, 12, 14}, {"opencv"}},
    {{4, 5},
     {"plumbbob", "radtan", "radialtangential", "brown", "brownconrady", "simpleradial", "radial"}},
    {{8, 12, 14}, {"rationalpolynomial"}},
    {{8}, {"fullopencv"}},
    {{12, 14}, {"thinprism"}}};

// Parts of the names of models whose field of view exceeds that of a pinhole image.
constexpr std::array kWideAngle = {"fisheye", "equi",       "kannala",   "kb",           "omni",
                                   "mei",     "unified",    "ucm",       "doublesphere", "fov",
                                   "atan",    "scaramuzza", "spherical", "ftheta"};

}  // namespace

std::optional<Distortion> ParseLens(const std::string& model, std::span<const double> coefficients,
                                    const std::string& place) {
  std::string name = LowerCase(model);  // without word separators
  std::erase_if(name, [](char c) { return c == '_' || c == '-' || c == ' '; });
  const auto found = std::ranges::find_if(
      kLensModels, [&](const auto& entry) { return entry.second.contains(name); });
  if (found == kLensModels.end()) {
    const bool is_wide_angle =
        name == "ds" || std::ranges::any_of(kWideAngle, [&](const char* part) {
          return name.find(part) != name.npos;
        });
    throw InputError(fmt::format(
        "{}: lens model '{}' is not {}", place, model,
        is_wide_angle
            ? "supported; expected OpenCV's for pinhole cameras: undistort the images first "
              "(cv::fisheye::undistortImage, COLMAP's image_undistorter) and give the camera of "
              "the undistorted ones"
            : "known; expected pinhole, opencv, plumb_bob, radtan, rational_polynomial or none: "
              "OpenCV's for pinhole cameras"));
  }
  const std::vector<size_t>& counts = found->first;
  const bool are_zero = std::ranges::all_of(coefficients, [](double k) { return k == 0.0; });
  if (std::ranges::find(counts, coefficients.size()) == counts.end() ||
      (name == "none" && !are_zero)) {
    const size_t shown = std::min<size_t>(coefficients.size(), 14);
    throw InputError(fmt::format(
        "{}: distortion has {} numbers ({}) for lens model '{}'; expected {}, in OpenCV's order: "
        "k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]",
        place, coefficients.size(), fmt::join(coefficients.first(shown), " "), model,
        name == "none" ? "none but 0" : fmt::format("{}", fmt::join(counts, ", "))));
  }
  if (coefficients.empty()) return std::nullopt;
  return DistortionOfCoefficients(coefficients);
}

namespace {

// True if the field's name denotes distortion, and not the size of a matrix.
bool IsOfDistortion(const std::string& plain_key) {
  if (plain_key.ends_with(".rows") || plain_key.ends_with(".cols")) return false;
  const std::string last = plain_key.substr(plain_key.rfind('.') + 1);
  return plain_key.find("distort") != plain_key.npos ||
         plain_key.find("distcoef") != plain_key.npos ||
         (last.starts_with("dist") && !last.starts_with("distance"));
}

class CalibrationReader {
 public:
  CalibrationReader(const NamedFields& fields, std::string file) : file_(std::move(file)) {
    for (const auto& [key, values] : fields) {
      std::string plain = LowerCase(key);
      std::erase(plain, '_');
      // Kalibr's and ORB-SLAM3's prefix of the first camera.
      if (plain.starts_with("cam0.")) {
        plain.erase(0, 5);
      } else if (plain.starts_with("camera1.")) {
        plain.replace(0, 8, "camera.");
      }
      // Fields of other cameras of Kalibr's: "cam1.intrinsics".
      const std::string camera = plain.substr(0, plain.find('.'));
      if (camera.size() > 3 && camera.starts_with("cam") &&
          camera.find_first_not_of("0123456789", 3) == camera.npos) {
        continue;
      }
      fields_[plain] = values;
      names_[plain] = key;
    }
  }

  Calibration Read() const {
    Calibration read;
    read.camera.distortion = Lens();
    const auto [fx, fy, cx, cy] = Intrinsics();
    const auto [width, height] = Size();
    RefusePartsOfImages(width, height);
    read.camera.camera = {width, height, fx, fy, cx, cy};
    if (!(fx > 0.0) || !(fy > 0.0)) {
      Refuse(fmt::format("focal lengths are {} and {}; expected pixels above 0", fx, fy));
    }
    read.body_from_camera = Motion({"tbs.data", "tbs"}, "T_BS");
    if (const auto camera_from_body = Motion({"tcamimu"}, "T_cam_imu")) {
      read.body_from_camera = camera_from_body->Inverse();
    }
    return read;
  }

 private:
  using Values = std::vector<std::string>;

  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", file_, what));
  }

  // First of these fields that exists; null when none does.
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

  std::optional<Rigid3d> Motion(std::initializer_list<const char*> keys, const char* name) const {
    const Values* matrix = Find(keys);
    if (matrix == nullptr) return std::nullopt;
    using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    const std::vector<double> numbers = Numbers(*matrix, name, 16);
    return RigidMotion(RowMajor(numbers.data()), fmt::format("{}: {}", file_, name));
  }

  double Number(const char* key) const {
    const Values* values = Find({key});
    if (values == nullptr) Refuse(fmt::format("{} is missing", key));
    return Numbers(*values, key, 1).front();
  }
  double NumberOrZero(const char* key) const { return Find({key}) == nullptr ? 0.0 : Number(key); }

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
      if (k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
        Refuse(fmt::format("camera matrix is {}; expected fx 0 cx 0 fy cy 0 0 1: is it transposed?",
                           fmt::join(k, " ")));
      }
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

  // Refuses ROS' region of interest and binning, with which the camera differs from that of the
  // whole image.
  void RefusePartsOfImages(int width, int height) const {
    for (const char* key : {"binningx", "binningy"}) {
      if (NumberOrZero(key) <= 1.0) continue;
      Refuse(fmt::format("{} is {}; expected 0 or 1: no binning of pixels", names_.at(key),
                         NumberOrZero(key)));
    }
    const std::array roi = {NumberOrZero("roi.xoffset"), NumberOrZero("roi.yoffset"),
                            NumberOrZero("roi.width"), NumberOrZero("roi.height")};
    if (roi[2] == 0.0 && roi[3] == 0.0) return;
    if (roi != std::array{0.0, 0.0, 1.0 * width, 1.0 * height}) {
      Refuse(fmt::format("roi is {}; expected the whole image, 0 0 {} {} or 0 0 0 0",
                         fmt::join(roi, " "), width, height));
    }
  }

  std::optional<Distortion> Lens() const {
    const Values* read = Find({"distortioncoefficients.data", "distortioncoefficients",
                               "distortioncoeffs.data", "distortioncoeffs", "distcoeffs.data",
                               "distcoeffs", "distcoeff.data", "distcoeff", "d.data", "d"});
    for (const auto& [key, values] : fields_) {
      if (key.find("fisheye") == key.npos || values.empty()) continue;
      const std::string& value = values.front();
      if (value == "false" || value == "False" || value == "no" || ParseNumber(value) == 0.0)
        continue;
      ParseLens("fisheye", {}, fmt::format("{}: {} is {}", file_, names_.at(key), value));
    }
    // Distortion in other fields would be ignored silently.
    for (const auto& [key, values] : fields_) {
      const bool has_number = std::ranges::any_of(
          values, [](const std::string& value) { return ParseNumber(value).has_value(); });
      if (&values == read || !IsOfDistortion(key) || !has_number) continue;
      Refuse(fmt::format("{} is not read; expected distortion_coefficients, dist_coeffs or D, once",
                         names_.at(key)));
    }
    std::vector<double> coefficients;
    if (read != nullptr) {
      coefficients = Numbers(*read, "distortion coefficients");
    } else {
      for (const char* key : {"camera.k1", "camera.k2", "camera.p1", "camera.p2", "camera.k3"}) {
        coefficients.push_back(NumberOrZero(key));
      }
    }
    for (const char* key : {"cameramodel", "cameratype", "camera.type", "distortionmodel"}) {
      const Values* name = Find({key});
      if (name == nullptr) continue;
      const std::string model = fmt::format("{}", fmt::join(*name, " "));
      if (!model.empty()) ParseLens(model, coefficients, file_);
    }
    return ParseLens("pinhole", coefficients, file_);
  }

  NamedFields fields_;
  std::map<std::string, std::string> names_;  // names as in the file, keyed by plain key
  std::string file_;
};

}  // namespace

Calibration ReadCameraFile(const std::filesystem::path& path, std::vector<Finding>* findings) {
  const std::string extension = path.extension().string(), name = path.string();
  if (extension == ".xml") {
    return CalibrationReader(XmlFields(ReadWholeFile(path), name), name).Read();
  }
  if (extension == ".yaml" || extension == ".yml") {
    return CalibrationReader(YamlFields(ReadWholeFile(path), name), name).Read();
  }
  if (extension == ".txt" || extension == ".bin") {
    return {ReadColmapCamera(path, findings), std::nullopt};
  }
  const auto of_nerfstudio = ReadNerfstudioCamera(path, findings);
  return {of_nerfstudio ? *of_nerfstudio : ReadCamera(path), std::nullopt};
}

}  // namespace soslam
