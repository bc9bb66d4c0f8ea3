// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace soslam {

// Checks that an ONNX file is complete, and that each of its tensors has as many numbers as its
// shape needs: OpenCV derives their number from the shape. Throws InputError, naming the file
// `name` and the tensor.
void CheckOnnx(std::string_view bytes, const std::string& name);

}  // namespace soslam
