// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "soslam/image/network_output.h"
#include "soslam/image/onnx_header.h"

namespace soslam {

// The library that runs a network.
enum class NetworkBackend { kOpenCv, kOnnxRuntime };
inline constexpr const char* kNetworkBackendNames[] = {"opencv", "onnxruntime"};

// Name and version, "OpenCV 4.6.0". Throws SettingsError for a backend that this software was built
// without.
std::string BackendVersion(NetworkBackend backend);

// An ONNX file, what it states about its network, and what is to run it.
struct NetworkFile {
  std::string name;  // path, for messages
  std::string bytes;
  OnnxHeader header;
  NetworkBackend backend = NetworkBackend::kOpenCv;

  // The input of the image, [1, 3, height, width].
  const OnnxValue& ImageInput() const;
  // Width and height of the image; 0 where the file does not fix them.
  cv::Size InputSize() const;
};

// Throws SettingsError as BackendVersion; InputError, naming the file, when it is missing or
// damaged, or holds a network that cannot detect objects in one image, or that the backend is known
// not to run.
NetworkFile ReadNetworkFile(const std::filesystem::path& path,
                            NetworkBackend backend = NetworkBackend::kOpenCv);

// A network that a backend has loaded and runs on one thread, so that its outputs depend on nothing
// but its inputs. Not to be shared between threads.
class Network {
 public:
  // `file` must outlive this.
  explicit Network(const NetworkFile& file) : file_(file) {}
  virtual ~Network() = default;

  // The outputs (CV_32F), in the order of the file's header, for an image of the input's size
  // (CV_8UC3, blue green red). Inputs that ask for the size of the image get that of the input.
  // Throws InputError when the backend cannot run the network on this size.
  std::vector<cv::Mat> Forward(const cv::Mat& image, PixelValues pixel_values);

 protected:
  // Inputs (CV_32F) and outputs are in the order of the file's header.
  virtual std::vector<cv::Mat> Run(const std::vector<cv::Mat>& inputs) = 0;

  const NetworkFile& file_;
};

// Throws InputError when the backend cannot load the network.
std::unique_ptr<Network> LoadNetwork(const NetworkFile& file);

// LoadNetwork with the exceptions of the backends. Without ONNX Runtime in this
// software, its network is null and its version empty: ReadNetworkFile has refused it.
std::unique_ptr<Network> LoadWithOpenCv(const NetworkFile& file);
std::unique_ptr<Network> LoadWithOnnxRuntime(const NetworkFile& file);
std::string OnnxRuntimeVersion();

}  // namespace soslam
