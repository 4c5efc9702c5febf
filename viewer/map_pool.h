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
  /// \param most maps to keep: where more are held at a time, those that are given back first are freed.
  explicit MapPool(std::size_t most) : most_(most) {}

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

  /// at() needs no map more than are kept.
  bool hasRoom() const {
    const std::lock_guard lock(shelf_->mutex);
    return shelf_->slots.size() < most_ ||
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
    take(*shelf_, slot);
  }

  /// Takes a slot off the shelf, whose mutex is held.
  static std::unique_ptr<Slot> take(Shelf& shelf, const Slot* slot) {
    const auto at = std::ranges::find(shelf.slots, slot, &std::unique_ptr<Slot>::get);
    std::unique_ptr<Slot> taken = std::move(*at);
    shelf.slots.erase(at);
    return taken;
  }

  std::shared_ptr<const Map> lend(Slot& slot) {
    {
      const std::lock_guard lock(shelf_->mutex);
      slot.free = false;
    }
    const auto give_back = [shelf = shelf_, &slot, most = most_](const Map*) {
      std::unique_ptr<Slot> surplus;  // freed outside the lock
      const std::lock_guard lock(shelf->mutex);
      slot.free = true;
      slot.handed_out.reset();  // it keeps this function, which keeps the shelf
      if (shelf->slots.size() > most) surplus = take(*shelf, &slot);
    };
    std::shared_ptr<const Map> handed_out(slot.map.get(), give_back);
    const std::lock_guard lock(shelf_->mutex);
    slot.handed_out = handed_out;
    return handed_out;
  }

  std::size_t most_;
  std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace vantage
