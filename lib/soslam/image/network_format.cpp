// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/image/detector.h"
#include "soslam/system/process.h"

namespace soslam {
namespace {

using Shape = std::vector<std::int64_t>;

// A layout that fits the shapes of outputs, with the number of columns after the classes and the
// indices of the outputs in the layout's order.
struct LayoutOfShapes {
  OutputLayout layout;
  int extra_columns;
  std::vector<int> outputs;
};

// Index of the only output with this number of sides; none for none and several such.
std::optional<int> OnlyWithSides(const std::vector<OnnxValue>& outputs, size_t sides) {
  std::optional<int> found;
  for (int i = 0; i < std::ssize(outputs); ++i) {
    if (outputs[i].shape.size() != sides) continue;
    if (found) return std::nullopt;
    found = i;
  }
  return found;
}

// Names by which networks tell their outputs, in the order of OutputLayout, and their indices.
struct NamedOutputs {
  std::vector<std::string> names;
  bool are_of_rf_detr = false;
  std::vector<int> indices = {};
};

// The outputs with known names; none unless all of them are there.
std::optional<NamedOutputs> FindNamed(const std::vector<OnnxValue>& outputs) {
  for (NamedOutputs named : {NamedOutputs{{"pred_boxes", "logits"}},          // Hugging Face
                             NamedOutputs{{"pred_boxes", "pred_logits"}},     // DETR and successors
                             NamedOutputs{{"dets", "labels"}, true},          // RF-DETR
                             NamedOutputs{{"boxes", "scores", "labels"}}}) {  // RT-DETR, D-FINE
    for (const std::string& name : named.names) {
      const auto output = std::ranges::find(outputs, name, &OnnxValue::name);
      if (output == outputs.end()) break;
      named.indices.push_back(static_cast<int>(output - outputs.begin()));
    }
    if (named.indices.size() == named.names.size()) return named;
  }
  return std::nullopt;
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

// The layout of an output of YOLO's.
std::optional<LayoutOfShapes> FitYolo(const NetworkFile& file, const Shape& shape, int index,
                                      int classes, OutputLayout wanted) {
  if (shape[0] > 1) return std::nullopt;
  const bool any = wanted == OutputLayout::kAuto;
  // Networks that remove overlaps themselves leave some hundred boxes; YOLOv5 with one class has
  // three a cell.
  constexpr std::int64_t kMost = 1000;
  const bool is_end_to_end =
      Metadata(file.header, "end2end") == "True" ||
      (shape[1] <= kMost && (classes != 1 || shape[1] != 3 * YoloCells(file.InputSize())));
  if (shape[2] == 6 && (any ? is_end_to_end : wanted == OutputLayout::kEndToEnd)) {
    return LayoutOfShapes{OutputLayout::kEndToEnd, 0, {index}};
  }
  const bool may_be_v5 = any || wanted == OutputLayout::kV5 || wanted == OutputLayout::kYolox;
  const bool may_be_v8 = any || wanted == OutputLayout::kV8;
  const std::int64_t extra_v5 = shape[2] - 5 - classes;
  const std::int64_t extra_v8 = shape[1] - 4 - classes;
  const LayoutOfShapes v5{any ? OutputLayout::kV5 : wanted, static_cast<int>(extra_v5), {index}};
  const LayoutOfShapes v8{OutputLayout::kV8, static_cast<int>(extra_v8), {index}};
  if (may_be_v5 && extra_v5 == 0) return v5;
  if (may_be_v8 && extra_v8 == 0) return v8;
  if (may_be_v5 && HasMasks(file.header, extra_v5)) return v5;
  const bool has_points = Metadata(file.header, "task") == "pose" && extra_v8 > 0;
  if (may_be_v8 && (has_points || HasMasks(file.header, extra_v8))) return v8;
  return std::nullopt;
}

// The layout of outputs with known names.
std::optional<LayoutOfShapes> FitNamed(const std::vector<OnnxValue>& outputs,
                                       const NamedOutputs& named, int classes,
                                       OutputLayout wanted) {
  const auto fit = [&](OutputLayout layout, int extra) -> std::optional<LayoutOfShapes> {
    if (wanted != OutputLayout::kAuto && wanted != layout) return std::nullopt;
    return LayoutOfShapes{layout, extra, named.indices};
  };
  if (named.indices.size() == 3) return fit(OutputLayout::kDetrBoxes, 0);
  const Shape& logits = outputs[named.indices[1]].shape;
  const std::int64_t extra = logits.size() == 3 ? logits[2] - classes : -1;
  if (extra == 0) return fit(OutputLayout::kDetr, 0);
  if (extra != 1) return std::nullopt;
  return named.are_of_rf_detr || wanted == OutputLayout::kDetr ? fit(OutputLayout::kDetr, 1)
                                                               : fit(OutputLayout::kDetrSoftmax, 0);
}

// The layout of PaddleDetection's outputs, whose names say nothing.
std::optional<LayoutOfShapes> FitPaddle(const std::vector<OnnxValue>& outputs, int classes,
                                        OutputLayout wanted) {
  const bool any = wanted == OutputLayout::kAuto;
  const auto rows = std::ranges::find_if(outputs, [](const OnnxValue& output) {
    return output.shape.size() == 2 && output.shape[1] == 6;
  });
  if (rows != outputs.end() && (any || wanted == OutputLayout::kPaddleNms)) {
    return LayoutOfShapes{OutputLayout::kPaddleNms, 0, {static_cast<int>(rows - outputs.begin())}};
  }
  if (!any && wanted != OutputLayout::kPaddle) return std::nullopt;
  for (int boxes = 0; boxes < std::ssize(outputs); ++boxes) {
    for (int scores = 0; scores < std::ssize(outputs); ++scores) {
      const Shape& of_boxes = outputs[boxes].shape;
      const Shape& of_scores = outputs[scores].shape;
      if (boxes != scores && of_boxes.size() == 3 && of_boxes[2] == 4 && of_scores.size() == 3 &&
          of_scores[1] == classes && of_scores[2] == of_boxes[1]) {
        return LayoutOfShapes{OutputLayout::kPaddle, 0, {boxes, scores}};
      }
    }
  }
  return std::nullopt;
}

// The layout of outputs. Throws InputError for shapes of another network, or of another number of
// classes.
LayoutOfShapes CheckedFit(const NetworkFile& file, const std::vector<OnnxValue>& outputs,
                          int classes, OutputLayout wanted) {
  const auto named = FindNamed(outputs);
  const auto only = OnlyWithSides(outputs, 3);
  std::optional<LayoutOfShapes> found;
  if (named) {
    found = FitNamed(outputs, *named, classes, wanted);
  } else if (found = FitPaddle(outputs, classes, wanted); !found && only) {
    found = FitYolo(file, outputs[*only].shape, *only, classes, wanted);
  }
  if (found) return *found;
  // The number of classes that the outputs seem to have; 0 where they show none.
  constexpr std::int64_t kMost = 2000;
  std::int64_t fields = 0;
  if (named && named->indices.size() == 2) {
    const Shape& logits = outputs[named->indices[1]].shape;
    if (logits.size() == 3) fields = logits[2];
  } else if (only) {
    fields = std::min(outputs[*only].shape[1] - 4, outputs[*only].shape[2] - 5);
  }
  std::vector<std::string> texts;
  for (const OnnxValue& output : outputs) {
    texts.push_back(output.name + " " + ShapeText(output.shape));
  }
  throw InputError(fmt::format(
      "{}: has the outputs {}; expected, for {} classes, {}{}", file.name, fmt::join(texts, ", "),
      classes,
      wanted == OutputLayout::kAuto
          ? fmt::format("one [1, N, {}] (v5, yolox), [1, {}, N] (v8) or [1, N, 6] (end_to_end), or "
                        "those of DETR or PaddleDetection",
                        5 + classes, 4 + classes)
          : fmt::format("the layout {}", kOutputLayoutNames[static_cast<int>(wanted)]),
      fields > 0 && fields <= kMost && fields != classes
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
  const auto& outputs = file.header.outputs;
  if (own.empty() && FindNamed(outputs)) {
    throw SettingsError(fmt::format(
        "{}: the size of its input is not fixed; set input_width_px and input_height_px to that of "
        "its training (RT-DETR and D-FINE: 640)",
        file.name));
  }
  constexpr int kUsualSide = 640;
  if (own.empty()) return {ImageShapedInput(image, {kUsualSide, kUsualSide})};
  // YOLOX as published has nothing in its graph that depends on the size.
  const auto only = OnlyWithSides(outputs, 3);
  const bool takes_any =
      only && outputs[*only].shape[1] == YoloCells(own) && outputs[*only].shape[2] == 5 + classes &&
      !file.header.operators.contains("Exp") && !file.header.metadata.contains("names");
  const cv::Size image_shaped = ImageShapedInput(image, own);
  if (!takes_any || image_shaped == own) return {own};
  return {image_shaped, own};
}

// An input and the outputs of the network for a uniform image of that size.
struct Probe {
  cv::Size input;
  std::vector<cv::Mat> outputs;
};

// Tries the sizes in turn; throws InputError when the backend does not run the last one either.
Probe RunProbe(const NetworkFile& file, std::vector<cv::Size> sizes) {
  const auto outputs_for = [&](const cv::Size& size) {
    const cv::Mat blank(size, CV_8UC3, cv::Scalar::all(0));
    return LoadNetwork(file)->Forward(blank, PixelValues::kRgbUnit);
  };
  // Backends trust what network files state about their layers.
  std::erase_if(sizes, [&, last = sizes.back()](const cv::Size& size) {
    const auto crash = CrashInOwnProcess([&] { outputs_for(size); });
    if (!crash || size != last) return crash.has_value();
    throw InputError(fmt::format(
        "{}: {} ends with {} when it loads or runs this network on an input of {} x {} pixels; "
        "expected an intact ONNX file",
        file.name, BackendVersion(file.backend), *crash, size.width, size.height));
  });
  const auto only = OnlyWithSides(file.header.outputs, 3);
  for (const cv::Size& size : sizes) {
    const bool is_last = size == sizes.back();
    try {
      const std::vector<cv::Mat> outputs = outputs_for(size);
      if (is_last || outputs.at(only.value()).size[1] == YoloCells(size)) return {size, outputs};
    } catch (const InputError&) {
      if (is_last) throw;
    }
  }
  throw std::logic_error("there is no size of input to try");
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

NetworkFormat FindFormat(const NetworkFile& file, int classes, const DetectorOptions& options,
                         const cv::Size& image) {
  std::vector<OnnxValue> declared = file.header.outputs;
  const auto named = FindNamed(declared);
  if (!named && OnlyWithSides(declared, 3)) {
    CheckedFit(file, declared, classes, options.output_layout);
  }
  const auto [input, outputs] = RunProbe(file, InputSizes(file, options, image, classes));
  for (size_t i = 0; i < outputs.size(); ++i) {
    declared[i].shape.assign(outputs[i].size.p, outputs[i].size.p + outputs[i].dims);
  }
  const auto [layout, extra, indices] = CheckedFit(file, declared, classes, options.output_layout);
  NetworkFormat format{layout, options.pixel_values, input, classes, extra, indices};
  const cv::Mat& output = outputs[indices[0]];
  const bool is_auto = options.output_layout == OutputLayout::kAuto;
  if (is_auto && named && indices.size() == 2) {
    // The number of logits says whether the last one is that of no object; their values must agree.
    const cv::Mat& logits = outputs[indices[1]];
    const bool expected = layout == OutputLayout::kDetrSoftmax;
    if (HasNoObjectClass(logits) != expected) {
      throw InputError(fmt::format(
          "{}: has {} logits for {} labels, but the last one {} that of no object; expected labels "
          "of all classes and no others (--labels FILE), or the output_layout, {} or {}",
          file.name, logits.size[2], expected ? logits.size[2] - 1 : logits.size[2],
          expected ? "is not" : "is", kOutputLayoutNames[static_cast<int>(OutputLayout::kDetr)],
          kOutputLayoutNames[static_cast<int>(OutputLayout::kDetrSoftmax)]));
    }
  }
  const bool has_rows = layout == OutputLayout::kV5 || layout == OutputLayout::kYolox;
  bool is_yolox =
      has_rows && output.size[1] == YoloCells(input) && !file.header.metadata.contains("names");
  if (is_yolox) {  // unless it is YOLOv6, whose objectness is always 1
    const cv::Mat rows(output.size[1], output.size[2], CV_32FC1, output.data);
    is_yolox = cv::countNonZero(rows.col(4) != 1.0F) > 0;
  }
  if (is_yolox && is_auto && HasBoxesInCells(output)) format.layout = OutputLayout::kYolox;
  if (options.pixel_values != PixelValues::kAuto) return format;
  if (named && named->are_of_rf_detr) {
    format.pixel_values = PixelValues::kRgbImageNet;
  } else if (PropertiesOf(layout).is_for_stretched) {
    throw SettingsError(fmt::format(
        "{}: pixel_values is auto, but networks of layout {} take rgb_0_1 (RT-DETR, D-FINE) or "
        "rgb_imagenet (DETR, PicoDet), which the file does not say; set it as in training",
        file.name, kOutputLayoutNames[static_cast<int>(layout)]));
  } else {
    format.pixel_values = is_yolox || format.layout == OutputLayout::kYolox ? PixelValues::kBgrByte
                                                                            : PixelValues::kRgbUnit;
  }
  return format;
}

}  // namespace soslam
