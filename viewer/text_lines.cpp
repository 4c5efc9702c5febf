#include "viewer/text_lines.h"

#include <algorithm>
#include <vector>

namespace vantage {
namespace {

/// "35", "0.61", "(21"; not "no." nor "0.61,".
bool isNumber(std::string_view word) {
  const std::size_t begin = word.find_first_not_of("(+-");
  if (begin == std::string_view::npos) return false;
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  word.remove_prefix(begin);
  return isDigit(word.front()) && isDigit(word.back()) &&
         std::ranges::all_of(word, [&](char c) { return isDigit(c) || c == '.'; });
}

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(' ', at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

/// Words with the numbers before them.
std::vector<std::string_view> piecesOf(std::string_view line) {
  std::vector<std::string_view> pieces;
  bool joins = false;
  for (const std::string_view word : wordsOf(line)) {
    if (joins)  // both are parts of the line, with a space between them
      pieces.back() = {pieces.back().data(), pieces.back().size() + 1 + word.size()};
    else
      pieces.push_back(word);
    joins = isNumber(word) || word == "..";
  }
  return pieces;
}

/// Fills lines one after the other.
class Lines {
 public:
  Lines(double width, const std::function<double(std::string_view)>& width_of)
      : width_(width), width_of_(width_of) {}

  void add(std::string_view line) {
    if (begun_) text_ += '\n';
    begun_ = true;
    begin_ = text_.size();
    empty_ = true;
    for (const std::string_view piece : piecesOf(line)) addPiece(piece);
  }

  std::string take() { return std::move(text_); }

 private:
  void addPiece(std::string_view piece) {
    if (!empty_ && fits(text_.substr(begin_) + ' ' + std::string(piece))) {
      text_ += ' ';
      text_ += piece;
      return;
    }
    if (!empty_) endLine();
    if (fits(piece)) {
      text_ += piece;
    } else if (piece.find(' ') != std::string_view::npos) {
      empty_ = true;
      for (const std::string_view word : wordsOf(piece)) addPiece(word);
    } else {
      addLetters(piece);
    }
    empty_ = false;
  }

  void addLetters(std::string_view word) {
    for (std::size_t at = 0; at < word.size();) {
      std::size_t end = at + 1;
      while (end < word.size() && (static_cast<unsigned char>(word[end]) & 0xc0) == 0x80) ++end;
      const std::string_view letter = word.substr(at, end - at);
      if (text_.size() > begin_ && !fits(text_.substr(begin_) + std::string(letter))) endLine();
      text_ += letter;
      at = end;
    }
  }

  bool fits(std::string_view line) const { return width_of_(line) <= width_; }

  void endLine() {
    text_ += '\n';
    begin_ = text_.size();
  }

  double width_;
  const std::function<double(std::string_view)>& width_of_;
  std::string text_;
  std::size_t begin_ = 0;  ///< of the line that is filled
  bool empty_ = true, begun_ = false;
};

}  // namespace

std::string brokenAtSpaces(const std::string& text, double width,
                           const std::function<double(std::string_view)>& width_of) {
  if (!(width > 0.0)) return text;
  Lines lines(width, width_of);
  std::string_view rest = text;
  for (;;) {
    const std::size_t end = rest.find('\n');
    lines.add(rest.substr(0, end));
    if (end == std::string_view::npos) return lines.take();
    rest.remove_prefix(end + 1);
  }
}

}  // namespace vantage
