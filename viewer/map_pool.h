#pragma once

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace vantage {

/// Maps that are too large to be made anew for each step: handed out, never changed while anyone holds one,
/// and brought to another step once nobody does. Handed out maps may be dropped on any thread, also after the
/// pool is gone; all else belongs to one thread. \tparam Map has `int step`
template <class Map>
class MapPool {
 public:
  /// The map at a step. \param make a new map, at whatever step it says. \param move (map, step) brings a map
  /// to the step; if it throws, the map is thrown away.
  template <class Make, class Move>
  std::shared_ptr<const Map> at(int step, const Make& make, const Move& move) {
    if (auto same = shared(step)) return same;
    Slot* slot = nearestFree(step);
    if (!slot) slot = add(make());
    if (slot->map->step != step) {
      try {
        move(*slot->map, step);
        slot->map->step = step;
      } catch (...) {
        remove(slot);
        throw;
      }
    }
    return lend(*slot);
  }

  /// A map that nobody holds can be used, or there are fewer than `most`.
  bool hasRoom(std::size_t most) const {
    const std::lock_guard lock(shelf_->mutex);
    return shelf_->slots.size() < most ||
           std::ranges::any_of(shelf_->slots, [](const auto& slot) { return slot->free; });
  }

  /// Maps that exist, handed out or not.
  std::size_t size() const {
    const std::lock_guard lock(shelf_->mutex);
    return shelf_->slots.size();
  }

 private:
  struct Slot {
    std::unique_ptr<Map> map;
    std::weak_ptr<const Map> handed_out = {};
    bool free = true;
  };
  struct Shelf {
    std::mutex mutex;
    std::vector<std::unique_ptr<Slot>> slots;
  };

  /// The map that someone already holds at that step.
  std::shared_ptr<const Map> shared(int step) {
    const std::lock_guard lock(shelf_->mutex);
    for (const auto& slot : shelf_->slots)
      if (slot->map->step == step)
        if (auto held = slot->handed_out.lock()) return held;
    return nullptr;
  }

  Slot* nearestFree(int step) {
    const std::lock_guard lock(shelf_->mutex);
    Slot* nearest = nullptr;
    for (const auto& slot : shelf_->slots) {
      const auto distance = [&](const Slot& s) { return std::abs(s.map->step - step); };
      if (slot->free && (!nearest || distance(*slot) < distance(*nearest))) nearest = slot.get();
    }
    return nearest;
  }

  Slot* add(std::unique_ptr<Map> map) {
    const std::lock_guard lock(shelf_->mutex);
    shelf_->slots.push_back(std::make_unique<Slot>(Slot{std::move(map)}));
    return shelf_->slots.back().get();
  }

  void remove(Slot* slot) {
    const std::lock_guard lock(shelf_->mutex);
    std::erase_if(shelf_->slots, [&](const auto& each) { return each.get() == slot; });
  }

  std::shared_ptr<const Map> lend(Slot& slot) {
    {
      const std::lock_guard lock(shelf_->mutex);
      slot.free = false;
    }
    const auto give_back = [shelf = shelf_, &slot](const Map*) {
      const std::lock_guard lock(shelf->mutex);
      slot.free = true;
    };
    std::shared_ptr<const Map> handed_out(slot.map.get(), give_back);
    const std::lock_guard lock(shelf_->mutex);
    slot.handed_out = handed_out;
    return handed_out;
  }

  std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace vantage
