// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "soslam/dataset/labelled_box.h"

namespace soslam {

// Expects the numbers of a box to within rounding.
inline void ExpectBox(const Box& box, const Box& expected) {
  EXPECT_NEAR(box.x_min, expected.x_min, 1e-9);
  EXPECT_NEAR(box.y_min, expected.y_min, 1e-9);
  EXPECT_NEAR(box.x_max, expected.x_max, 1e-9);
  EXPECT_NEAR(box.y_max, expected.y_max, 1e-9);
}

inline void ExpectLabelledBox(const LabelledBox& row, const FrameKey& frame,
                              const std::string& label, double score, const Box& box) {
  EXPECT_EQ(row.frame, frame);
  EXPECT_EQ(row.label, label);
  EXPECT_EQ(row.score, score);
  ExpectBox(row.box, box);
}

}  // namespace soslam
