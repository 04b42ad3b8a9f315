// SPDX-License-Identifier: Apache-2.0
#pragma once

/// In which order the joints of bodies are best eliminated where rows couple bodies, and what each
/// elimination touches: the symbolic half of articulated_factor.hpp.
///
/// Rows of two moving bodies b and c put a 6 × 6 block K_bc beside their inertias. When the joints
/// of b are eliminated, the bodies that are coupled with it come to be coupled with each other, and
/// what is left of its blocks passes to its parent, with which it then moves as one. So a body
/// comes after its children, and of those that may come next the one with the fewest couplings
/// does: minimum degree (George and Liu, Computer Solution of Large Sparse Positive Definite
/// Systems, 1981) on trees. Without couplings all are one chain of leaves first and nothing is
/// filled in. The steps and the blocks of an island (tree_islands.hpp) are ranges.

#include <utility>
#include <vector>

#include "softgauss/engine/dynamics/tree_islands.hpp"

namespace softgauss {

class EliminationOrder {
 public:
  /// A body that is eliminated later, and the block K of both: rows of the earlier one, columns of
  /// the later.
  struct Coupling {
    int body = 0;
    int block = 0;
  };
  /// What a block of an eliminated body is added to: to that of its parent and the same body, which
  /// may have it transposed, or, where that body is the parent, to the parent's inertia with its
  /// transpose.
  struct Passing {
    enum class To : char { block, transposedBlock, inertia };
    int from = 0;  ///< block
    To to = To::block;
    int target = 0;  ///< block or body
  };
  struct Step {
    int body = 0;
    int coupling = 0, couplings = 0;  ///< first of couplings(), and how many
    int pair = 0;                     ///< first of pairBlocks()
    int passing = 0, passingEnd = 0;  ///< of passings()
  };

  EliminationOrder() = default;
  explicit EliminationOrder(const Model& model);

  /// Finds the order for these pairs of bodies, none of them the world; any order, repetitions
  /// allowed. Keeps what it has where they are those of the last call. `islands`, of which no pair
  /// has two: null where all bodies are one.
  void find(std::vector<std::pair<int, int>>& pairs, const TreeIslands* islands = nullptr);

  /// What is of one island.
  struct Part {
    Segment steps, blocks;
  };
  const Part& part(int island) const { return parts_[idx(island)]; }
  std::span<const Step> steps(Segment of) const {
    return std::span(steps_).subspan(idx(of.begin), idx(of.end - of.begin));
  }
  const Coupling* couplings(const Step& s) const { return couplings_.data() + s.coupling; }
  /// Blocks of each two couplings of a step, the first with the second, the first with the third, …
  const int* pairBlocks(const Step& s) const { return pairBlocks_.data() + s.pair; }
  const std::vector<Passing>& passings() const { return passings_; }
  int blocks() const { return blocks_; }
  /// Whether body a is eliminated before body b.
  bool isBefore(int a, int b) const { return place_[idx(a)] < place_[idx(b)]; }
  /// The block of two bodies that are coupled.
  int block(int earlier, int later) const;

 private:
  void findPart(Segments bodies, Segment pairs);
  void findSequence(Segments bodies, Segment pairs);
  void eliminate(int body);
  int addBlock(int a, int b);
  void addStep(int body);
  void connect(int a, int b);

  std::vector<int> parent_;
  std::vector<std::pair<int, int>> pairs_;  ///< by island, sorted, each once
  std::vector<int> islandOf_;               ///< (bodies) in that order; empty: all are one
  bool found_ = false;

  std::vector<Part> parts_;
  std::vector<Step> steps_;
  std::vector<Coupling> couplings_;
  std::vector<int> pairBlocks_;
  std::vector<Passing> passings_;
  int blocks_ = 0;

  std::vector<int> sequence_, place_;           ///< bodies in order; where each is
  std::vector<std::vector<Coupling>> later_;    ///< of each body, those that follow it
  std::vector<std::vector<int>> neighbours_;    ///< scratch: of each body, those not yet eliminated
  std::vector<int> children_, ready_, around_;  ///< scratch
};

}  // namespace softgauss
