// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/elimination_tree.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

namespace soslam {
namespace {

// A group while it grows, its variables numbered in the order of minimum degree.
struct Node {
  int parent = -1;
  std::vector<int> pivots;
  std::vector<int> neighbours;
  std::vector<int> children;
  double pivot_rows = 0.0;
  double neighbour_rows = 0.0;
};

// Minimum degree order: the variable at each position.
std::vector<int> MinimumDegreeOrder(const SymmetricBlocks& pattern) {
  std::vector<Eigen::Triplet<double>> couplings;
  for (const auto& block : pattern.blocks()) couplings.emplace_back(block.row, block.column, 1.0);
  Eigen::SparseMatrix<double> matrix(pattern.NumVariables(), pattern.NumVariables());
  matrix.setFromTriplets(couplings.begin(), couplings.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(matrix.selfadjointView<Eigen::Lower>(), order);
  return {order.indices().begin(), order.indices().end()};
}

std::vector<int> Inverse(const std::vector<int>& order) {
  std::vector<int> positions(order.size());
  for (size_t i = 0; i < order.size(); ++i) {
    positions[static_cast<size_t>(order[i])] = static_cast<int>(i);
  }
  return positions;
}

// One node per variable, with the neighbours that it has when it is eliminated.
std::vector<Node> Nodes(const SymmetricBlocks& pattern, const std::vector<int>& order) {
  const std::vector<int> positions = Inverse(order);
  std::vector<Node> nodes(order.size());
  for (const auto& block : pattern.blocks()) {
    if (block.row == block.column) continue;
    const int one = positions[static_cast<size_t>(block.row)];
    const int other = positions[static_cast<size_t>(block.column)];
    nodes[static_cast<size_t>(std::min(one, other))].neighbours.push_back(std::max(one, other));
  }
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    Node& node = nodes[static_cast<size_t>(i)];
    for (const int child : node.children) {
      const auto& inherited = nodes[static_cast<size_t>(child)].neighbours;
      node.neighbours.insert(node.neighbours.end(), inherited.begin() + 1, inherited.end());
    }
    std::ranges::sort(node.neighbours);
    node.neighbours.erase(std::unique(node.neighbours.begin(), node.neighbours.end()),
                          node.neighbours.end());
    node.pivots = {i};
    node.pivot_rows = pattern.Size(order[static_cast<size_t>(i)]);
    for (const int neighbour : node.neighbours) {
      node.neighbour_rows += pattern.Size(order[static_cast<size_t>(neighbour)]);
    }
    if (node.neighbours.empty()) continue;
    node.parent = node.neighbours.front();
    nodes[static_cast<size_t>(node.parent)].children.push_back(i);
  }
  return nodes;
}

// Estimated multiplications for a front: its elimination, its assembly and the update of its
// parent.
double Work(double pivots, double neighbours) {
  constexpr double kPivotsThatAssemblyIsWorth = 8.0;
  constexpr double kWorkOfAnyFront = 2000.0;
  const double rows = pivots + neighbours;
  return (pivots + kPivotsThatAssemblyIsWorth) * rows * rows + kWorkOfAnyFront;
}

// Child after child, where that saves work.
void MergeChildren(std::vector<Node>* nodes) {
  for (size_t i = 0; i < nodes->size(); ++i) {
    Node& node = (*nodes)[i];
    std::vector<int> children;
    for (const int index : node.children) {
      Node& child = (*nodes)[static_cast<size_t>(index)];
      if (Work(child.pivot_rows + node.pivot_rows, node.neighbour_rows) >
          Work(child.pivot_rows, child.neighbour_rows) +
              Work(node.pivot_rows, node.neighbour_rows)) {
        children.push_back(index);
        continue;
      }
      node.pivot_rows += child.pivot_rows;
      node.pivots.insert(node.pivots.end(), child.pivots.begin(), child.pivots.end());
      children.insert(children.end(), child.children.begin(), child.children.end());
      child.pivots.clear();
    }
    std::ranges::sort(node.pivots);
    std::ranges::sort(children);
    node.children = children;
  }
}

// Indices of the nodes that are left, each after all that is below it.
std::vector<size_t> Postorder(const std::vector<Node>& nodes) {
  std::vector<size_t> order, pending;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].parent < 0) pending.push_back(i);
  }
  while (!pending.empty()) {  // parents first; turned round below
    order.push_back(pending.back());
    pending.pop_back();
    for (const int child : nodes[order.back()].children) {
      pending.push_back(static_cast<size_t>(child));
    }
  }
  std::ranges::reverse(order);
  return order;
}

}  // namespace

std::vector<EliminationGroup> EliminationTree(const SymmetricBlocks& pattern) {
  const std::vector<int> order = MinimumDegreeOrder(pattern);
  std::vector<Node> nodes = Nodes(pattern, order);
  MergeChildren(&nodes);

  std::vector<EliminationGroup> groups;
  std::vector<int> group_of(order.size()), elimination(order.size());
  int eliminated = 0;
  for (const size_t i : Postorder(nodes)) {
    EliminationGroup group;
    for (const int pivot : nodes[i].pivots) {
      group_of[static_cast<size_t>(pivot)] = static_cast<int>(groups.size());
      elimination[static_cast<size_t>(pivot)] = eliminated++;
      group.pivots.push_back(order[static_cast<size_t>(pivot)]);
    }
    group.neighbours = std::move(nodes[i].neighbours);  // by position, until all have their place
    groups.push_back(std::move(group));
  }
  for (EliminationGroup& group : groups) {
    if (group.neighbours.empty()) continue;
    std::ranges::sort(group.neighbours, {},
                      [&](int position) { return elimination[static_cast<size_t>(position)]; });
    group.parent = group_of[static_cast<size_t>(group.neighbours.front())];
    for (int& neighbour : group.neighbours) neighbour = order[static_cast<size_t>(neighbour)];
  }
  return groups;
}

}  // namespace soslam
