#include "core/volume/octree_nodes.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace vantage::octree {
namespace {

using Node = octomap::OcTreeNode;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// A node's place: its lower corner and edge, finest voxels.
struct Cube {
  Eigen::Vector3i corner = Eigen::Vector3i::Zero();
  int edge = kKeys;

  Cube child(unsigned n) const {
    const int half = edge / 2;
    return {corner + half * Eigen::Vector3i(n & 1, n >> 1 & 1, n >> 2 & 1), half};
  }
  KeyBox box() const { return {corner, corner + Eigen::Vector3i::Constant(edge)}; }
  bool meets(const KeyBox& b) const {
    return ((corner.array() + edge) > b.begin.array()).all() && (corner.array() < b.end.array()).all();
  }
};

/// Number of the child of a node with this edge that holds a voxel.
unsigned childOf(const Eigen::Vector3i& key, int edge) {
  const int half = edge / 2;
  return (key.x() & half ? 1u : 0u) | (key.y() & half ? 2u : 0u) | (key.z() & half ? 4u : 0u);
}

/// OctoMap frees the slots of a node's children only when it prunes.
struct Slots : Node {
  static void free(Node& node) {
    auto& slots = node.*(&Slots::children);
    delete[] slots;
    slots = nullptr;
  }
};

bool sameBits(const float* values, int count) {
  return std::memcmp(values, values + 1, sizeof(float) * (count - 1)) == 0;
}

}  // namespace

/// Access to the root and to the recursive removal of nodes.
class OctreeNodes::Tree : public octomap::OcTree {
 public:
  explicit Tree(double voxel_size_m) : octomap::OcTree(voxel_size_m) {}
  Tree(const Tree& other) : octomap::OcTree(other) {}

  const Node* child(const Node* node, unsigned n) const {
    return nodeChildExists(node, n) ? getNodeChild(node, n) : nullptr;
  }
  bool isLeaf(const Node* node) const { return !nodeHasChildren(node); }

  Node* ensureRoot(bool& fresh) {
    fresh = root == nullptr;
    if (fresh) {
      root = new Node();
      tree_size = 1;
      size_changed = true;
    }
    return root;
  }
  /// The child to go on with below `node`, which a fresh node or a leaf gets first. `fresh` tells that the
  /// node has been made for what is stored below it and is no leaf, and then the same of the child.
  Node* ensureChild(Node* node, unsigned n, bool& fresh) {
    if (!fresh && isLeaf(node)) expandNode(node);
    fresh = !nodeChildExists(node, n);
    return fresh ? createNodeChild(node, n) : getNodeChild(node, n);
  }
  void removeBelow(Node* node) {
    for (unsigned n = 0; n < 8; ++n)
      if (nodeChildExists(node, n)) removeChild(node, n);
    Slots::free(*node);
  }
  void removeChild(Node* node, unsigned n) {
    removeBelow(getNodeChild(node, n));
    deleteNodeChild(node, n);
  }
  void becomeLeaf(Node* node, float log_odds) {
    removeBelow(node);
    node->setLogOdds(log_odds);
  }

  /// Removes the children for which `keep` is false. \return whether any is left
  template <class Keep>
  bool keepChildren(Node* node, const Keep& keep) {
    bool any = false;
    for (unsigned n = 0; n < 8; ++n)
      if (nodeChildExists(node, n)) {
        if (keep(n))
          any = true;
        else
          removeChild(node, n);
      }
    return any;
  }

  void fill(Node* node, bool fresh, const Cube& cube, const KeyBox& box, float log_odds) {
    if (box.holds(cube.box())) return becomeLeaf(node, log_odds);
    if (!fresh && isLeaf(node) && node->getLogOdds() == log_odds) return;
    for (unsigned n = 0; n < 8; ++n) {
      const Cube below = cube.child(n);
      if (!below.meets(box)) continue;
      bool fresh_child = fresh;
      Node* next = ensureChild(node, n, fresh_child);
      fresh = false;
      fill(next, fresh_child, below, box, log_odds);
    }
    pruneNode(node);
  }

  /// Removes what lies in the box. \return false if nothing is left of the node
  bool remove(Node* node, const Cube& cube, const KeyBox& box) {
    if (!cube.meets(box)) return true;
    if (box.holds(cube.box())) return false;
    if (isLeaf(node)) expandNode(node);
    return keepChildren(node, [&](unsigned n) { return remove(getNodeChild(node, n), cube.child(n), box); });
  }

  /// Removes what lies outside the box. \return false if nothing is left of the node
  bool cut(Node* node, const Cube& cube, const KeyBox& box) {
    if (!cube.meets(box)) return false;
    if (box.holds(cube.box())) return true;
    if (isLeaf(node)) expandNode(node);
    return keepChildren(node, [&](unsigned n) { return cut(getNodeChild(node, n), cube.child(n), box); });
  }

  /// Writes a run of `count` values, not all the same, below a node.
  void writeRun(Node* node, bool fresh, const float* values, int count) {
    // Now, since a node that has lost its last child for a while looks like a leaf.
    if (!fresh && isLeaf(node)) expandNode(node);
    const int part = count / 8;
    for (unsigned n = 0; n < 8; ++n, values += part) {
      bool fresh_child = true;
      if (part > 1 && !sameBits(values, part)) {
        Node* next = ensureChild(node, n, fresh_child);
        writeRun(next, fresh_child, values, part);
      } else if (!std::isnan(*values)) {
        becomeLeaf(ensureChild(node, n, fresh_child), *values);
      } else if (nodeChildExists(node, n)) {
        removeChild(node, n);
      }
    }
    pruneNode(node);
  }

  void setClamps(float low, float high) {
    clamping_thres_min = low;
    clamping_thres_max = high;
  }
  /// Brings inner nodes up to date and prunes; with a band leaves become labels, and unknown ones are
  /// dropped. \return false if nothing is left of the node
  bool tidy(Node* node, const OccupancyBand* band) {
    if (isLeaf(node)) {
      if (!band) return true;
      const VoxelState state = band->label(node->getLogOdds());
      node->setLogOdds(state == VoxelState::Occupied ? getClampingThresMaxLog() : getClampingThresMinLog());
      return state != VoxelState::Unknown;
    }
    const bool any = keepChildren(node, [&](unsigned n) { return tidy(getNodeChild(node, n), band); });
    if (any && !pruneNode(node)) node->updateOccupancyChildren();
    return any;
  }
  void tidy(const OccupancyBand* band) {
    if (root && !tidy(root, band)) clear();
  }

  /// Calls `visit(leaf, part of the leaf in the box)` until it returns false.
  template <class Visit>
  bool visitLeaves(const Node* node, const Cube& cube, const KeyBox& box, const Visit& visit) const {
    if (isLeaf(node)) return visit(*node, cube.box().cut(box));
    for (unsigned n = 0; n < 8; ++n)
      if (const Node* next = child(node, n)) {
        const Cube below = cube.child(n);
        if (below.meets(box) && !visitLeaves(next, below, box, visit)) return false;
      }
    return true;
  }
  /// The same from the lowest node that holds the whole box.
  template <class Visit>
  void visitLeaves(const KeyBox& box, const Visit& visit) const {
    const Node* node = root;
    if (!node || box.empty()) return;
    Cube cube;
    const Eigen::Vector3i last = box.end - Eigen::Vector3i::Ones();
    while (!isLeaf(node)) {
      const unsigned n = childOf(box.begin, cube.edge);
      if (n != childOf(last, cube.edge)) break;
      node = child(node, n);
      if (!node) return;
      cube = cube.child(n);
    }
    visitLeaves(node, cube, box, visit);
  }
};

OctreeNodes::OctreeNodes(double voxel_size_m) : tree_(std::make_unique<Tree>(voxel_size_m)) {}
OctreeNodes::~OctreeNodes() = default;
OctreeNodes::OctreeNodes(OctreeNodes&&) noexcept = default;
OctreeNodes& OctreeNodes::operator=(OctreeNodes&&) noexcept = default;

std::optional<float> OctreeNodes::at(const Eigen::Vector3i& key) const {
  const Node* node = tree_->getRoot();
  for (int edge = kKeys; node && !tree_->isLeaf(node); edge /= 2)
    node = tree_->child(node, childOf(key, edge));
  if (!node) return std::nullopt;
  return node->getLogOdds();
}

void OctreeNodes::read(const KeyBox& box, std::span<float> log_odds) const {
  std::fill(log_odds.begin(), log_odds.end(), kNothing);
  const Eigen::Vector3i size = box.end - box.begin;
  tree_->visitLeaves(box, [&](const Node& leaf, const KeyBox& part) {
    const Eigen::Vector3i from = part.begin - box.begin, to = part.end - box.begin;
    for (int k = from.z(); k < to.z(); ++k)
      for (int j = from.y(); j < to.y(); ++j) {
        float* row = log_odds.data() + (static_cast<std::size_t>(k) * size.y() + j) * size.x();
        std::fill(row + from.x(), row + to.x(), leaf.getLogOdds());
      }
    return true;
  });
}

void OctreeNodes::readBlock(const Eigen::Vector3i& block, Block& log_odds) const {
  const Eigen::Vector3i corner = block * kBlock;
  log_odds.fill(kNothing);
  const KeyBox box{corner, corner + Eigen::Vector3i::Constant(kBlock)};
  tree_->visitLeaves(box, [&](const Node& leaf, const KeyBox& part) {
    // The part is a node of the block or the whole block: one run.
    const Eigen::Vector3i at = part.begin - corner;
    int first = 0;
    for (int bit = 0; bit < 3; ++bit)
      first |= ((at.x() >> bit & 1) | (at.y() >> bit & 1) << 1 | (at.z() >> bit & 1) << 2) << 3 * bit;
    const int edge = part.end.x() - part.begin.x();
    std::fill_n(log_odds.begin() + first, edge * edge * edge, leaf.getLogOdds());
    return true;
  });
}

void OctreeNodes::writeBlock(const Eigen::Vector3i& block, const Block& log_odds) {
  const Eigen::Vector3i corner = block * kBlock;
  const bool same = sameBits(log_odds.data(), kBlockVoxels);
  if (same && std::isnan(log_odds[0])) return remove({corner, corner + Eigen::Vector3i::Constant(kBlock)});
  bool fresh = false;
  Node* node = tree_->ensureRoot(fresh);
  for (int edge = kKeys; edge > kBlock; edge /= 2)
    node = tree_->ensureChild(node, childOf(corner, edge), fresh);
  if (same)
    tree_->becomeLeaf(node, log_odds[0]);
  else
    tree_->writeRun(node, fresh, log_odds.data(), kBlockVoxels);
}

void OctreeNodes::fill(const KeyBox& box, float log_odds) {
  if (box.empty()) return;
  bool fresh = false;
  Node* root = tree_->ensureRoot(fresh);
  tree_->fill(root, fresh, Cube{}, box, log_odds);
}

void OctreeNodes::remove(const KeyBox& box) {
  if (tree_->getRoot() && !tree_->remove(tree_->getRoot(), Cube{}, box)) tree_->clear();
}

void OctreeNodes::cut(const KeyBox& box) {
  if (tree_->getRoot() && !tree_->cut(tree_->getRoot(), Cube{}, box)) tree_->clear();
}

void OctreeNodes::visit(const KeyBox& box, const std::function<void(const KeyBox&, float)>& visit) const {
  tree_->visitLeaves(box, [&](const Node& leaf, const KeyBox& part) {
    visit(part, leaf.getLogOdds());
    return true;
  });
}

VoxelState OctreeNodes::labelByMax(const KeyBox& box, const OccupancyBand& band) const {
  bool occupied = false, all_free = true;
  double seen = 0.0;
  tree_->visitLeaves(box, [&](const Node& leaf, const KeyBox& part) {
    const VoxelState state = band.label(leaf.getLogOdds());
    occupied = state == VoxelState::Occupied;
    all_free = all_free && state == VoxelState::Free;
    seen += part.voxels();
    return !occupied;
  });
  if (occupied) return VoxelState::Occupied;
  const bool complete = seen == box.voxels() && seen > 0.0;  // D-A6: missing is unknown
  return all_free && complete ? VoxelState::Free : VoxelState::Unknown;
}

double OctreeNodes::probabilitySum(const KeyBox& box) const {
  double sum = 0.5 * box.voxels();
  tree_->visitLeaves(box, [&](const Node& leaf, const KeyBox& part) {
    sum += part.voxels() * (1.0 / (1.0 + std::exp(-double(leaf.getLogOdds()))) - 0.5);
    return true;
  });
  return sum;
}

std::size_t OctreeNodes::nodes() const {
  return tree_->size();
}

std::size_t OctreeNodes::memoryBytes() const {
  return tree_->memoryUsage();
}

std::size_t OctreeNodes::writeProbabilities(std::ostream& out) const {
  Tree tidied(*tree_);
  tidied.tidy(nullptr);
  tidied.writeData(out);
  return tidied.size();
}

std::size_t OctreeNodes::writeLabels(std::ostream& out, const OccupancyBand& band) const {
  Tree labels(*tree_);
  labels.tidy(&band);
  labels.writeBinaryData(out);
  return labels.size();
}

void OctreeNodes::readProbabilities(std::istream& in) {
  tree_->readData(in);
}

void OctreeNodes::readLabels(std::istream& in, float free, float occupied) {
  tree_->setClamps(free, occupied);
  tree_->readBinaryData(in);
}

}  // namespace vantage::octree
