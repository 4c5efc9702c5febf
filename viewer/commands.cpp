#include "viewer/commands.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <stdexcept>

namespace vantage {
namespace {

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Cost of finding the query's letters in the text, in their order: least for the query itself at the start
/// of a word; else letters that are skipped inside a word weigh more than whole words. Empty if they are not
/// there.
std::optional<int> costOf(const std::string& text, const std::string& query) {
  const auto same = [](char a, char b) { return lower(a) == lower(b); };
  for (auto from = text.begin(); !query.empty();) {
    const auto found = std::search(from, text.end(), query.begin(), query.end(), same);
    if (found == text.end()) break;
    if (found == text.begin() || *(found - 1) == ' ') return -2;
    from = found + 1;
  }
  int cost = 0;
  std::size_t at = 0;
  bool joined = true;
  for (const char wanted : query) {
    if (wanted == ' ') {
      joined = true;
      continue;
    }
    const std::size_t start = at;
    while (at < text.size() && lower(text[at]) != lower(wanted)) ++at;
    if (at == text.size()) return std::nullopt;
    const bool word_start = at == 0 || text[at - 1] == ' ';
    if (at != start || joined) cost += word_start ? 1 : 4 + static_cast<int>(at - start);
    joined = false;
    ++at;
  }
  return cost;
}

}  // namespace

Command& Commands::add(Command command) {
  if (find(command.id)) throw std::logic_error("command '" + command.id + "' exists already");
  if (const Command* other = forKeys(command.keys))
    throw std::logic_error("keys " + textOf(command.keys) + " of '" + command.id + "' belong to '" +
                           other->id + "'");
  return all_.emplace_back(std::move(command));
}

void Commands::letRepeat(const std::string& id) {
  const auto found = std::ranges::find(all_, id, &Command::id);
  if (found == all_.end()) throw std::logic_error("there is no command " + id);
  found->repeats = true;
}

const Command* Commands::find(const std::string& id) const {
  const auto found = std::ranges::find(all_, id, &Command::id);
  return found == all_.end() ? nullptr : &*found;
}

bool Commands::run(const std::string& id) const {
  const Command* command = find(id);
  if (!command || !command->enabled()) return false;
  command->run();
  return true;
}

const Command* Commands::forKeys(const Shortcut& keys) const {
  if (keys.key == Key::None) return nullptr;
  const auto found = std::ranges::find(all_, keys, &Command::keys);
  return found == all_.end() ? nullptr : &*found;
}

std::vector<const Command*> Commands::matching(const std::string& query) const {
  std::vector<std::pair<int, const Command*>> found;
  for (const Command& command : all_)
    if (const auto cost = costOf(command.group + " " + command.title, query))
      found.emplace_back(*cost, &command);
  std::ranges::stable_sort(found, {}, [](const auto& entry) { return entry.first; });
  std::vector<const Command*> commands;
  for (const auto& [cost, command] : found) commands.push_back(command);
  return commands;
}

}  // namespace vantage
