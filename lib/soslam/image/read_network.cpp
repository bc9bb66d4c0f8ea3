// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <optional>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/image/network.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// OpenCV before 4.7, as in Debian 12, which CertainlyFails is about.
constexpr bool kIsOldOpenCv = CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7;

bool HasAny(const OnnxHeader& header, const std::vector<const char*>& operators) {
  return std::ranges::any_of(operators,
                             [&](const char* name) { return header.operators.contains(name); });
}

// The command of Ultralytics that exports a network that OpenCV runs.
std::string ExportCommand(const NetworkFile& file, const std::string& further = "") {
  const cv::Size size = file.InputSize();
  return fmt::format(
      "yolo export model={}.pt format=onnx opset=12 imgsz={} half=False dynamic=False{}",
      fs::path(file.name).stem().string(),
      size.empty() ? "480,640" : fmt::format("{},{}", size.height, size.width), further);
}

// The property of a network that OpenCV 4.6 does not support, with what to do; none without one.
std::optional<std::string> CertainlyFails(const NetworkFile& file) {
  if (HasAny(file.header, {"GridSample"})) {
    return "it is a transformer with deformable attention (RT-DETR, D-FINE, DEIM, RF-DETR), whose "
           "GridSample OpenCV lacks; run it with ONNX Runtime (--backend onnxruntime), or in its "
           "own "
           "software and import its boxes from a file";
  }
  if (HasAny(file.header, {"DynamicQuantizeLinear", "ConvInteger", "MatMulInteger"})) {
    return "its weights are quantised (int8); export it with " + ExportCommand(file, " int8=False");
  }
  const auto is_half = [](const OnnxValue& input) { return input.type == OnnxValue::kHalf; };
  if (file.header.has_half_weights || std::ranges::any_of(file.header.inputs, is_half)) {
    return "its numbers are 16-bit floating point; export it with " + ExportCommand(file);
  }
  if (HasAny(file.header, {"TopK", "NonMaxSuppression"})) {
    return "it selects its boxes itself (end to end); export it with " +
           ExportCommand(file, " end2end=False nms=False");
  }
  return std::nullopt;
}

// The likely reason why OpenCV failed with a network, from its header; empty without one.
std::string LikelyReason(const NetworkFile& file) {
  if (file.backend != NetworkBackend::kOpenCv) return "";
  if (const auto certain = CertainlyFails(file)) return ": " + *certain;
  constexpr int kBestOpset = 12;
  if (HasAny(file.header, {"QLinearConv", "QuantizeLinear"})) {
    return ": its weights are quantised (int8); export it with " + ExportCommand(file);
  }
  if (std::ranges::count(file.ImageInput().shape, 0) > 0) {
    return ": the size of its input is not fixed; export it with " + ExportCommand(file);
  }
  if (file.header.opset > kBestOpset) {
    return fmt::format(": it has opset {}; export it with {}", file.header.opset,
                       ExportCommand(file));
  }
  return "";
}

// The format of a network that is no ONNX file, by its first bytes; none for others.
std::optional<std::string> OtherFormat(std::string_view bytes) {
  struct Signature {
    size_t place;
    std::string_view bytes;
    const char* format;
  };
  using namespace std::string_view_literals;
  constexpr const char* kPyTorch = "a checkpoint of PyTorch";
  constexpr const char* kTensorRt = "an engine of TensorRT";
  constexpr Signature kSignatures[] = {{0, "PK\x03\x04"sv, "a zip archive"},
                                       {0, "\x80\x02"sv, kPyTorch},
                                       {8, "{\""sv, "a safetensors file"},
                                       {4, "TFL3"sv, "a model of TensorFlow Lite"},
                                       {4, "{\""sv, kTensorRt},
                                       {0, "ftrt"sv, kTensorRt},
                                       {0, "<?xml"sv, "a model of OpenVINO"},
                                       {0, "\x89HDF"sv, "a model of Keras"},
                                       {0, "7767517"sv, "a model of NCNN"}};
  if (bytes.starts_with("PK"sv) && bytes.find("/data.pkl"sv) != bytes.npos) return kPyTorch;
  for (const Signature& signature : kSignatures) {
    if (bytes.substr(std::min(signature.place, bytes.size())).starts_with(signature.bytes)) {
      return signature.format;
    }
  }
  return std::nullopt;
}

std::string HowToJoin(const fs::path& network) {
  return fmt::format(
      "export it with external_data=False, or join them with python3 -c \"import "
      "onnx; onnx.save(onnx.load('{}'), 'one_file.onnx')\"",
      network.string());
}

// The value of an input beside the image; empty for unknown ones. Networks are told that the image
// has the size of their input, so that boxes are in its pixels, and that none of these is padding.
cv::Mat FurtherInput(const OnnxValue& input, const cv::Size& size) {
  const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
  if (input.name == "orig_target_sizes") return cv::Mat_<float>({1, 2}, {width, height});
  if (input.name == "im_shape") return cv::Mat_<float>({1, 2}, {height, width});
  if (input.name == "scale_factor") return cv::Mat_<float>({1, 2}, {1.0F, 1.0F});
  if (input.name != "pixel_mask" || input.shape.size() != 3) return {};
  const auto side = [&](size_t axis, int of_image) {
    constexpr std::int64_t kMost = 4096;
    const std::int64_t declared = input.shape[axis];
    return declared > 0 && declared <= kMost ? static_cast<int>(declared) : of_image;
  };
  return {{1, side(1, size.height), side(2, size.width)}, CV_32FC1, cv::Scalar(1)};
}

bool IsImage(const OnnxValue& input) { return input.shape.size() == 4; }

// Throws InputError for a network that is none of those that detect objects in one image.
void CheckIsDetector(const NetworkFile& file) {
  const auto& inputs = file.header.inputs;
  const auto task = file.header.metadata.find("task");
  if (task != file.header.metadata.end() && task->second != "detect" && task->second != "segment" &&
      task->second != "pose") {
    throw InputError(
        fmt::format("{}: is a network for the task '{}'; expected detect, segment or "
                    "pose, whose boxes are upright",
                    file.name, task->second));
  }
  const auto is_known = [](const OnnxValue& input) {
    return IsImage(input) || !FurtherInput(input, {1, 1}).empty();
  };
  const auto& shape = file.ImageInput().shape;
  const auto is = [&](size_t axis, std::int64_t side) {
    return shape[axis] == side || shape[axis] == 0;
  };
  if (std::ranges::count_if(inputs, IsImage) != 1 || !std::ranges::all_of(inputs, is_known) ||
      !is(0, 1) || !is(1, 3)) {
    std::vector<std::string> found;
    for (const OnnxValue& input : inputs)
      found.push_back(input.name + " " + ShapeText(input.shape));
    throw InputError(fmt::format(
        "{}: has {} inputs: {}; expected one image of shape [1, 3, height, width], and besides at "
        "most orig_target_sizes, im_shape, scale_factor and pixel_mask",
        file.name, inputs.size(), fmt::join(found, ", ")));
  }
  const int type = file.ImageInput().type;
  if (type != 0 && type != OnnxValue::kFloat && type != OnnxValue::kHalf) {
    throw InputError(fmt::format(
        "{}: its input has numbers of ONNX's type {}; expected floating point, which is {}",
        file.name, type, OnnxValue::kFloat));
  }
}

// Throws the InputError for a network that a backend cannot load or run, or std::bad_alloc if
// `error` is that, or OpenCV's equivalent: then the file is not at fault.
[[noreturn]] void Refuse(const NetworkFile& file, const std::string& what,
                         const std::exception& error) {
  const auto* of_opencv = dynamic_cast<const cv::Exception*>(&error);
  if ((of_opencv != nullptr && of_opencv->code == cv::Error::StsNoMem) ||
      dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    throw std::bad_alloc();
  }
  std::string reason = of_opencv != nullptr ? of_opencv->err : error.what();
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  const size_t begin = reason.find_first_not_of("> ");
  const size_t end = reason.find_last_not_of("> ");
  reason = begin == reason.npos ? "no reason given" : reason.substr(begin, end - begin + 1);
  throw InputError(fmt::format("{}: {}{} ({})", file.name, what, LikelyReason(file), reason));
}

}  // namespace

std::string BackendVersion(NetworkBackend backend) {
  if (backend == NetworkBackend::kOpenCv) return std::string("OpenCV ") + CV_VERSION;
  if (!OnnxRuntimeVersion().empty()) return "ONNX Runtime " + OnnxRuntimeVersion();
  throw SettingsError(
      "backend is onnxruntime, which this program was built without; install libonnxruntime-dev "
      "(Debian 13 and newer) and build again, or set backend = opencv");
}

const OnnxValue& NetworkFile::ImageInput() const {
  static const OnnxValue kNone{"", 0, {0, 0, 0, 0}};
  const auto found = std::ranges::find_if(header.inputs, IsImage);
  return found == header.inputs.end() ? kNone : *found;
}

cv::Size NetworkFile::InputSize() const {
  const auto& shape = ImageInput().shape;
  constexpr std::int64_t kMax = 1 << 15;
  const auto side = [](std::int64_t pixels) {
    return static_cast<int>(pixels > kMax ? 0 : pixels);
  };
  return {side(shape[3]), side(shape[2])};
}

NetworkFile ReadNetworkFile(const fs::path& path, NetworkBackend backend) {
  BackendVersion(backend);
  std::ifstream stream(path, std::ios::binary);
  if (!IsFile(path) || !stream) {
    throw InputError(path.string() + ": cannot be read; expected an ONNX file");
  }
  RecordInput(path);
  NetworkFile file{path.string(),
                   {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()},
                   {},
                   backend};
  for (const std::string_view ending : {".data", "_data"}) {
    if (!file.name.ends_with(fmt::format(".onnx{}", ending))) continue;
    std::string network = path.filename().string();
    network.resize(network.size() - ending.size());
    throw InputError(fmt::format("{}: has the weights of {}; expected one file with both: {}",
                                 file.name, network, HowToJoin(network)));
  }
  if (const auto format = OtherFormat(file.bytes)) {
    throw InputError(fmt::format(
        "{}: is {}; expected an ONNX file: a network of Ultralytics is exported with {}, others as "
        "docs/detections.md says",
        file.name, *format, ExportCommand(file)));
  }
  file.header = ReadOnnxHeader(file.bytes, file.name);
  if (!file.header.files_of_weights.empty()) {  // networks are read from memory
    const std::string& weights = *file.header.files_of_weights.begin();
    throw InputError(fmt::format(
        "{}: its weights are in {}{}; expected one file with all of them: {}", file.name, weights,
        IsFile(path.parent_path() / weights) ? "" : ", which is not beside it (copy that, too)",
        HowToJoin(path.filename())));
  }
  if (const auto reason = CertainlyFails(file);
      reason && kIsOldOpenCv && backend == NetworkBackend::kOpenCv) {
    throw InputError(
        fmt::format("{}: does not run in {}: {}", file.name, BackendVersion(backend), *reason));
  }
  CheckIsDetector(file);
  return file;
}

std::unique_ptr<Network> LoadNetwork(const NetworkFile& file) {
  try {
    return file.backend == NetworkBackend::kOpenCv ? LoadWithOpenCv(file)
                                                   : LoadWithOnnxRuntime(file);
  } catch (const std::exception& error) {  // from the backend or its libraries
    Refuse(file,
           fmt::format("is not an ONNX network that {} can load", BackendVersion(file.backend)),
           error);
  }
}

std::vector<cv::Mat> Network::Forward(const cv::Mat& image, PixelValues pixel_values) {
  std::vector<cv::Mat> inputs;
  for (const OnnxValue& input : file_.header.inputs) {
    if (!IsImage(input)) {
      inputs.push_back(FurtherInput(input, image.size()));
      continue;
    }
    const bool is_unit = pixel_values != PixelValues::kBgrByte;
    inputs.push_back(cv::dnn::blobFromImage(image, is_unit ? 1.0 / 255.0 : 1.0, cv::Size(),
                                            cv::Scalar(), is_unit /* swap blue and red */));
    if (pixel_values != PixelValues::kRgbImageNet) continue;
    constexpr double kMean[] = {0.485, 0.456, 0.406}, kDeviation[] = {0.229, 0.224, 0.225};
    for (int channel = 0; channel < 3; ++channel) {
      cv::Mat plane(image.size(), CV_32FC1, inputs.back().ptr<float>(0, channel));
      plane.convertTo(plane, CV_32F, 1.0 / kDeviation[channel],
                      -kMean[channel] / kDeviation[channel]);
    }
  }
  try {
    return Run(inputs);
  } catch (const std::exception& error) {  // from the backend or its libraries
    const cv::Size size = file_.InputSize();
    Refuse(file_,
           fmt::format("cannot be run on an input of {} x {} pixels{}", image.cols, image.rows,
                       size.empty() || size == image.size()
                           ? ""
                           : fmt::format("; its own is {} x {}", size.width, size.height)),
           error);
  }
}

}  // namespace soslam
