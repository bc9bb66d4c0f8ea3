// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "base/error.h"
#include "base/process.h"
#include "image/yolo_detector.h"

namespace soslam {
namespace {

using Shape = std::vector<std::int64_t>;

// A layout that fits the shape of an output, with the number of columns after the classes.
struct LayoutOfShape {
  YoloLayout layout;
  int extra_columns;
};

// The output of three dimensions that the file declares; none if it declares no or several such.
std::optional<Shape> DeclaredShape(const OnnxHeader& header) {
  std::optional<Shape> found;
  for (const OnnxValue& output : header.outputs) {
    if (output.shape.size() != 3) continue;
    if (found) return std::nullopt;
    found = output.shape;
  }
  return found;
}

std::string Metadata(const OnnxHeader& header, const std::string& key) {
  const auto found = header.metadata.find(key);
  return found == header.metadata.end() ? "" : found->second;
}

// True if a network has this many coefficients of masks: as many as the masks of another output.
bool HasMasks(const OnnxHeader& header, std::int64_t columns) {
  return std::ranges::any_of(header.outputs, [&](const OnnxValue& output) {
    return output.shape.size() == 4 && output.shape[1] == columns;
  });
}

// True for [1, N, 6] of a network that removes overlaps itself, which leaves some hundred boxes;
// YOLOv5 with one class has three a cell.
bool IsEndToEnd(const NetworkFile& file, const Shape& shape, int classes) {
  if (shape[2] != 6) return false;
  if (Metadata(file.header, "end2end") == "True") return true;
  constexpr std::int64_t kMost = 1000;
  return shape[1] <= kMost && (classes != 1 || shape[1] != 3 * YoloCells(file.InputSize()));
}

std::optional<LayoutOfShape> Fit(const NetworkFile& file, const Shape& shape, int classes,
                                 YoloLayout wanted) {
  if (shape.size() != 3 || shape[0] > 1) return std::nullopt;
  const bool any = wanted == YoloLayout::kAuto;
  if (any ? IsEndToEnd(file, shape, classes) : wanted == YoloLayout::kEndToEnd && shape[2] == 6) {
    return LayoutOfShape{YoloLayout::kEndToEnd, 0};
  }
  const bool may_be_v5 = any || wanted == YoloLayout::kV5 || wanted == YoloLayout::kYolox;
  const bool may_be_v8 = any || wanted == YoloLayout::kV8;
  const std::int64_t extra_v5 = shape[2] - 5 - classes;
  const std::int64_t extra_v8 = shape[1] - 4 - classes;
  const LayoutOfShape v5{any ? YoloLayout::kV5 : wanted, static_cast<int>(extra_v5)};
  const LayoutOfShape v8{YoloLayout::kV8, static_cast<int>(extra_v8)};
  if (may_be_v5 && extra_v5 == 0) return v5;
  if (may_be_v8 && extra_v8 == 0) return v8;
  if (may_be_v5 && HasMasks(file.header, extra_v5)) return v5;
  const bool has_points = Metadata(file.header, "task") == "pose" && extra_v8 > 0;
  if (may_be_v8 && (has_points || HasMasks(file.header, extra_v8))) return v8;
  return std::nullopt;
}

// Fit that throws InputError for a shape of another network, or of another number of classes.
LayoutOfShape CheckedFit(const NetworkFile& file, const Shape& shape, int classes,
                         YoloLayout wanted) {
  if (const auto found = Fit(file, shape, classes, wanted)) return *found;
  const std::int64_t fields = shape.size() != 3 ? 0 : std::min(shape[1] - 4, shape[2] - 5);
  constexpr std::int64_t kMostFields = 2000;
  throw InputError(fmt::format(
      "{}: output has shape {}; expected, for {} classes, {}{}", file.name, ShapeText(shape),
      classes,
      wanted == YoloLayout::kAuto
          ? fmt::format("[1, N, {}] (v5, yolox), [1, {}, N] (v8) or [1, N, 6] (end_to_end)",
                        5 + classes, 4 + classes)
          : fmt::format("the layout {}", kYoloLayoutNames[static_cast<int>(wanted)]),
      fields > 0 && fields <= kMostFields && fields != classes
          ? fmt::format(". If it has {} classes, --labels FILE names them", fields)
          : ""));
}

// The sizes of input to try, best first.
std::vector<cv::Size> InputSizes(const NetworkFile& file, const DetectorOptions& options,
                                 const cv::Size& image, int classes) {
  if ((options.input_width == 0) != (options.input_height == 0)) {
    throw SettingsError(
        fmt::format("input_width_px is {} and input_height_px is {}; expected both or neither",
                    options.input_width, options.input_height));
  }
  if (options.input_width > 0) return {{options.input_width, options.input_height}};
  const cv::Size own = file.InputSize();
  constexpr int kUsualSide = 640;
  if (own.empty()) return {ImageShapedInput(image, {kUsualSide, kUsualSide})};
  // YOLOX as published has nothing in its graph that depends on the size.
  const auto shape = DeclaredShape(file.header);
  const bool takes_any = shape && (*shape)[1] == YoloCells(own) && (*shape)[2] == 5 + classes &&
                         !file.header.operators.contains("Exp") &&
                         !file.header.metadata.contains("names");
  const cv::Size image_shaped = ImageShapedInput(image, own);
  if (!takes_any || image_shaped == own) return {own};
  return {image_shaped, own};
}

// An input and the output of the network for a uniform image of that size.
struct Probe {
  cv::Size input;
  cv::Mat output;
};

// Tries the sizes in turn; throws InputError when OpenCV does not run the last one either.
Probe RunProbe(const NetworkFile& file, std::vector<cv::Size> sizes) {
  const auto output_for = [&](const cv::Size& size) {
    const cv::Mat blank(size, CV_8UC3, cv::Scalar::all(0));
    return YoloNetwork(file).Forward(blank, PixelValues::kRgbUnit);
  };
  // OpenCV trusts what network files state about their layers.
  std::erase_if(sizes, [&, last = sizes.back()](const cv::Size& size) {
    const auto crash = CrashInOwnProcess([&] { output_for(size); });
    if (!crash || size != last) return crash.has_value();
    throw InputError(fmt::format(
        "{}: OpenCV {} ends with {} when it loads or runs this network on an input of {} x {} "
        "pixels; expected an intact ONNX file",
        file.name, CV_VERSION, *crash, size.width, size.height));
  });
  for (const cv::Size& size : sizes) {
    const bool is_last = size == sizes.back();
    try {
      const cv::Mat output = output_for(size);
      if (is_last || output.size[1] == YoloCells(size)) return {size, output};
    } catch (const InputError&) {
      if (is_last) throw;
    }
  }
  throw std::logic_error("there is no size of input to try");
}

// True for YOLOv6, whose output has an objectness that is always 1.
bool HasConstantObjectness(const cv::Mat& output) {
  const cv::Mat rows(output.size[1], output.size[2], CV_32FC1, output.data);
  return cv::countNonZero(rows.col(4) != 1.0F) == 0;
}

}  // namespace

cv::Size ImageShapedInput(const cv::Size& image, const cv::Size& own) {
  constexpr double kMostArea = 5e5;
  constexpr int kMultiple = 32;
  const double area =
      std::clamp<double>(image.area(), own.area(), std::max(kMostArea, 1.0 * own.area()));
  const double scale = std::sqrt(area / image.area());
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(scale * pixels / kMultiple))) * kMultiple;
  };
  return {side(image.width), side(image.height)};
}

YoloFormat FindFormat(const NetworkFile& file, int classes, const DetectorOptions& options,
                      const cv::Size& image) {
  if (const auto shape = DeclaredShape(file.header)) {
    CheckedFit(file, *shape, classes, options.output_layout);
  }
  const auto [input, output] = RunProbe(file, InputSizes(file, options, image, classes));
  const auto [layout, extra] =
      CheckedFit(file, Shape(output.size.p, output.size.p + 3), classes, options.output_layout);
  YoloFormat format{layout, options.pixel_values, input, classes, extra};
  const bool has_rows = layout == YoloLayout::kV5 || layout == YoloLayout::kYolox;
  const bool is_yolox = has_rows && output.size[1] == YoloCells(input) &&
                        !file.header.metadata.contains("names") && !HasConstantObjectness(output);
  if (is_yolox && options.output_layout == YoloLayout::kAuto && HasBoxesInCells(output)) {
    format.layout = YoloLayout::kYolox;
  }
  if (options.pixel_values == PixelValues::kAuto) {
    format.pixel_values = is_yolox || format.layout == YoloLayout::kYolox ? PixelValues::kBgrByte
                                                                          : PixelValues::kRgbUnit;
  }
  return format;
}

}  // namespace soslam
