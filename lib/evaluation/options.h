// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"

namespace soslam {

// The protocol of evaluation has no settings: numbers from different runs stay comparable.
struct EvaluateOptions {
  void Describe(OptionVisitor&) {}
};

}  // namespace soslam
