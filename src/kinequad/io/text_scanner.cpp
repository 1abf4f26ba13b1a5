#include "kinequad/io/text_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace kinequad {
namespace {

/// A token fit for a one-line message: short and printable.
std::string quoted(std::string_view text) {
    std::string shown;
    for (const char c : text.substr(0, 24)) {
        if (TextScanner::is_blank(c) || TextScanner::is_newline(c)) break;
        shown += c > ' ' && c <= '~' ? c : '?';
    }
    return "\"" + shown + "\"";
}

}  // namespace

bool TextScanner::skip_joint() {
    std::size_t next = position_ + 1;
    if (next < text_.size() && text_[next] == '\r') ++next;
    if (next < text_.size() && text_[next] == '\n') ++next;
    if (next == position_ + 1) return false;
    position_ = next;
    return true;
}

void TextScanner::skip_line() {
    const std::size_t end = text_.find_first_of("\n\r", position_);
    position_ = end == std::string_view::npos ? text_.size() : end + 1;
}

void TextScanner::skip_joined_lines() {
    while (true) {
        const std::size_t begin = position_;
        skip_line();
        std::size_t end = position_;
        while (end > begin && is_newline(text_[end - 1])) --end;
        const bool joined = end > begin && end < position_ && text_[end - 1] == '\\';
        if (!joined) return;
        // A comment ends with its line, whatever its last character.
        if (text_.substr(begin, end - begin).find(comment_) != std::string_view::npos) return;
        // The line feed of a pair still lies ahead.
        if (text_[end] == '\r' && position_ < text_.size() && text_[position_] == '\n') ++position_;
    }
}

std::string_view TextScanner::read_token() {
    const std::size_t begin = position_;
    while (!at_token_end()) ++position_;
    return text_.substr(begin, position_ - begin);
}

double TextScanner::read_number(const char* what) {
    const char* begin = text_.data() + position_;
    const char* const end = text_.data() + text_.size();
    // from_chars knows no plus sign.
    if (begin != end && *begin == '+' && begin + 1 != end && begin[1] != '-') ++begin;
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    const std::size_t start = position_;
    if (error == std::errc::invalid_argument) {
        fail(InputFault::file, fmt::format("{} expected, found {}", what, quoted(rest())));
    }
    if (error == std::errc::result_out_of_range) {
        const bool tiny =
            std::string_view(begin, stop).find_first_of('-', 1) != std::string_view::npos;
        value = tiny ? 0 : std::numeric_limits<double>::infinity();
    }
    position_ = static_cast<std::size_t>(stop - text_.data());
    if (!at_token_end()) {
        position_ = start;
        fail(InputFault::file, fmt::format("{} expected, found {}", what, quoted(rest())));
    }
    return value;
}

std::int64_t TextScanner::read_integer_prefix(const char* what) {
    const char* begin = text_.data() + position_;
    const char* const end = text_.data() + text_.size();
    if (begin != end && *begin == '+' && begin + 1 != end && begin[1] != '-') ++begin;
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc{}) {
        fail(InputFault::file, fmt::format("{} expected, found {}", what, quoted(rest())));
    }
    position_ = static_cast<std::size_t>(stop - text_.data());
    return value;
}

std::int64_t TextScanner::read_integer(const char* what) {
    const std::size_t start = position_;
    const std::int64_t value = read_integer_prefix(what);
    if (!at_token_end()) {
        position_ = start;
        fail(InputFault::file, fmt::format("{} expected, found {}", what, quoted(rest())));
    }
    return value;
}

void TextScanner::fail_at(std::size_t position, InputFault fault,
                          const std::string& message) const {
    const std::string_view before = text_.substr(0, std::min(position, text_.size()));
    auto line = std::count(before.begin(), before.end(), '\n');
    if (line == 0) line = std::count(before.begin(), before.end(), '\r');
    throw InputError(fault, fmt::format("{}:{}: {}", name_, line + 1, message));
}

}  // namespace kinequad
