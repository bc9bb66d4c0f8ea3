// SPDX-License-Identifier: BSD-3-Clause
#include "image/nearest_edge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/wide_loops.h"

// cv::distanceTransform gives the nearest edge pixel as a label, but only together with a chamfer
// mask: on real images a tenth to a quarter of the labels are wrong and lead to an edge pixel up to
// 5 px farther than the nearest one. Hence an exact algorithm in two passes, like that of Meijster,
// Roerdink and Hesselink, "A general algorithm for computing distance transforms in linear time"
// (2000): first the nearest edge pixel in the same column, then the nearest of these along the row.
// Their second pass, a stack of parabolas, has an unpredictable branch for every pixel. Here SIMD
// registers compare columns, and only few columns are candidates: the nearest columns along a row
// are row minima of a totally monotone matrix (Aggarwal, Klawe, Moran, Shor and Wilber, "Geometric
// applications of a matrix-searching algorithm", 1987), which bisection finds.

namespace soslam {
namespace {

constexpr std::int16_t kNone = -1;

// Column and row of a pixel in the memory layout of cv::Vec2s.
static_assert(std::endian::native == std::endian::little);
SOSLAM_IN_WIDE_LOOPS int PixelInMemory(int column, int row) { return column | row << 16; }

// The row of the nearest edge pixel in the same column, CV_16SC1; kNone in columns without edges.
// Computed row by row, so that the compiler vectorises over columns.
cv::Mat NearestEdgeRowInColumn(const cv::Mat& edges) {
  const int width = edges.cols;
  // Distances to the next edge pixel in a column. Without one they count on from kFar, which is
  // larger than any distance, and never overflow.
  constexpr std::uint16_t kFar = 32768;
  cv::Mat up(edges.size(), CV_16UC1);
  std::vector<std::uint16_t> previous(static_cast<size_t>(width), kFar);
  const std::uint16_t* above = previous.data();
  for (int y = 0; y < edges.rows; ++y) {
    const std::uint8_t* edge = edges.ptr<std::uint8_t>(y);
    std::uint16_t* distance = up.ptr<std::uint16_t>(y);
    for (int x = 0; x < width; ++x) {
      distance[x] = static_cast<std::uint16_t>(edge[x] != 0 ? 0 : above[x] + 1);
    }
    above = distance;
  }
  cv::Mat nearest_row(edges.size(), CV_16SC1);
  std::vector<std::uint16_t> down(static_cast<size_t>(width), kFar);
  for (int y = edges.rows - 1; y >= 0; --y) {
    const std::uint16_t* upward = up.ptr<std::uint16_t>(y);
    std::uint16_t* downward = down.data();
    std::int16_t* nearest = nearest_row.ptr<std::int16_t>(y);
    for (int x = 0; x < width; ++x) {
      downward[x] = static_cast<std::uint16_t>(upward[x] == 0 ? 0 : downward[x] + 1);
      const std::uint16_t least = std::min(upward[x], downward[x]);
      const int row = downward[x] < upward[x] ? y + least : y - least;
      nearest[x] = least >= kFar ? kNone : static_cast<std::int16_t>(row);
    }
  }
  return nearest_row;
}

// The squared distance from pixel x of a row y to the edge pixel of column u is
//   (x - u)^2 + (row(u) - y)^2 = x^2 + constant(u) - 2 x u.
// Without x^2, which is the same for all columns, it fits 32 bits: both squares are below 2^30.
// Along a row the nearest column never moves to the left, so between two pixels whose nearest
// columns are known only the columns between those are candidates.
class RowSearch {
 public:
  // `columns` are those with edges, from left to right; not empty.
  RowSearch(int width, const std::vector<int>& columns)
      : width_(width),
        blocks_(static_cast<size_t>((width + kLanes - 1) / kLanes)),
        count_(columns.size()),
        columns_(columns),
        constants_(count_ + kLanes, std::numeric_limits<int>::max()),
        edges_(count_ + kLanes),
        nearest_(blocks_ + 1),
        found_(kLanes * blocks_) {
    columns_.resize(count_ + kLanes);
  }

  // Writes the nearest edge pixel of each x (PixelInMemory); of several that of the leftmost
  // column.
  SOSLAM_WIDE_LOOPS void Find(const std::int16_t* nearest_row_of_columns, int y, int* nearest) {
    const std::int16_t* __restrict row = nearest_row_of_columns;
    int* __restrict constants = constants_.data();
    int* __restrict edges = edges_.data();
    for (size_t i = 0; i < count_; ++i) {
      const int u = columns_[i];
      constants[i] = u * u + (row[i] - y) * (row[i] - y);
      edges[i] = PixelInMemory(u, row[i]);
    }
    FindAtBlocks();
    for (size_t block = 0; block < blocks_; ++block) FindInBlock(block);
    std::copy_n(found_.data(), width_, nearest);
  }

 private:
  static constexpr int kLanes = 8;  // pixels of a block
  static constexpr EightIntegers kLane = {0, 1, 2, 3, 4, 5, 6, 7};

  // Nearest columns of the first pixel of each block and of the last pixel of the row, by
  // bisection.
  SOSLAM_IN_WIDE_LOOPS void FindAtBlocks() {
    nearest_[0] = Nearest(0, 0, count_ - 1);
    nearest_[blocks_] = Nearest(width_ - 1, nearest_[0], count_ - 1);
    for (size_t step = std::bit_ceil(blocks_) / 2; step > 0; step /= 2) {
      for (size_t block = step; block < blocks_; block += 2 * step) {
        nearest_[block] = Nearest(kLanes * static_cast<int>(block), nearest_[block - step],
                                  nearest_[std::min(block + step, blocks_)]);
      }
    }
  }

  // The nearest of columns_[first] to columns_[last]. It may examine further ones, which are not
  // nearer.
  SOSLAM_IN_WIDE_LOOPS size_t Nearest(int x, size_t first, size_t last) const {
    EightIntegers least = EightIntegers{} + std::numeric_limits<int>::max();
    EightIntegers nearest = {};
    for (size_t i = first; i <= last; i += kLanes) {
      EightIntegers columns, constants;
      Load(&columns_[i], &columns);
      Load(&constants_[i], &constants);
      const EightIntegers squared = constants - 2 * x * columns;
      const auto is_nearer = squared < least;
      least = is_nearer ? squared : least;
      nearest = is_nearer ? static_cast<int>(i) + kLane : nearest;
    }
    const EightIntegers farthest = EightIntegers{} + std::numeric_limits<int>::max();
    return static_cast<size_t>(Least(least == Least(least) ? nearest : farthest));
  }

  SOSLAM_IN_WIDE_LOOPS void FindInBlock(size_t block) {
    const EightIntegers twice_x = 2 * (kLanes * static_cast<int>(block) + kLane);
    EightIntegers least = EightIntegers{} + std::numeric_limits<int>::max();
    EightIntegers edge = {};
    for (size_t i = nearest_[block]; i <= nearest_[block + 1]; ++i) {
      const EightIntegers squared = constants_[i] - twice_x * columns_[i];
      const auto is_nearer = squared < least;
      least = is_nearer ? squared : least;
      edge = is_nearer ? EightIntegers{} + edges_[i] : edge;
    }
    Store(edge, &found_[kLanes * block]);
  }

  SOSLAM_IN_WIDE_LOOPS static int Least(const EightIntegers& of) {
    const EightIntegers others = __builtin_shufflevector(of, of, 4, 5, 6, 7, 0, 1, 2, 3);
    const EightIntegers four = of < others ? of : others;
    return std::min(std::min(four[0], four[1]), std::min(four[2], four[3]));
  }

  int width_;
  size_t blocks_;
  size_t
      count_;  // number of columns; arrays are longer by kLanes, as whole SIMD registers are read
  std::vector<int> columns_;
  std::vector<int> constants_;   // by column; padded with values that are never nearest
  std::vector<int> edges_;       // edge pixel of each column
  std::vector<size_t> nearest_;  // index of the nearest column, for the first pixel of each block
  std::vector<int> found_;       // nearest edge pixel, for each pixel of the blocks
};

// Moves the entries of columns with edges together, from left to right; returns these columns.
std::vector<int> CompactColumns(cv::Mat* nearest_row) {
  std::vector<int> columns;
  for (int u = 0; u < nearest_row->cols; ++u) {
    if (nearest_row->at<std::int16_t>(0, u) != kNone) columns.push_back(u);
  }
  if (columns.size() == static_cast<size_t>(nearest_row->cols)) return columns;
  for (int y = 0; y < nearest_row->rows; ++y) {
    auto* row = nearest_row->ptr<std::int16_t>(y);
    for (size_t i = 0; i < columns.size(); ++i) row[i] = row[columns[i]];
  }
  return columns;
}

}  // namespace

cv::Mat NearestEdgeMap(const cv::Mat& edges) {
  CV_Assert(edges.type() == CV_8UC1 && edges.cols <= 32767 && edges.rows <= 32767);
  if (edges.empty()) return {edges.size(), CV_16SC2};
  cv::Mat nearest_row = NearestEdgeRowInColumn(edges);
  const std::vector<int> columns = CompactColumns(&nearest_row);
  if (columns.empty()) return {edges.size(), CV_16SC2, cv::Scalar(kNone, kNone)};
  cv::Mat nearest(edges.size(), CV_16SC2);
  RowSearch search(edges.cols, columns);
  for (int y = 0; y < edges.rows; ++y) {
    search.Find(nearest_row.ptr<std::int16_t>(y), y, nearest.ptr<int>(y));
  }
  return nearest;
}

cv::Mat DistanceMap(const cv::Mat& nearest_edge) {
  CV_Assert(nearest_edge.type() == CV_16SC2);
  cv::Mat distance(nearest_edge.size(), CV_32FC1);
  // For integers below 2^24 the root in single precision equals the rounded root in double
  // precision.
  const bool is_small =
      std::int64_t{distance.cols} * distance.cols + std::int64_t{distance.rows} * distance.rows <
      1 << 24;
  for (int y = 0; y < distance.rows; ++y) {
    const auto* edge = nearest_edge.ptr<std::int16_t>(y);
    auto* out = distance.ptr<float>(y);
    const auto write = [&](auto real) {
      using Real = decltype(real);
      for (int x = 0; x < distance.cols; ++x) {
        const int dx = edge[2 * x] - x;
        const int dy = edge[2 * x + 1] - y;
        const auto root = static_cast<float>(std::sqrt(static_cast<Real>(dx * dx + dy * dy)));
        out[x] = edge[2 * x] == kNone ? std::numeric_limits<float>::infinity() : root;
      }
    };
    is_small ? write(float()) : write(double());
  }
  return distance;
}

}  // namespace soslam
