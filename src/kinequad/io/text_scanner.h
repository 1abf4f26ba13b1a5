#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kinequad/core/error.h"

namespace kinequad {

/// Walks over the text of a mesh file token by token. A line ends at a line feed or a carriage
/// return; what is wrong is thrown as `InputError` with the file's name and the line's number.
class TextScanner {
public:
    /// Neither `text` nor `name` is copied. `comment` begins a comment that ends with the line.
    TextScanner(std::string_view text, const std::string& name, char comment = '#')
        : text_(text), name_(name), comment_(comment) {}

    /// Steps over spaces and tabs, and over a backslash that joins a line to the next one.
    void skip_blanks() {
        while (position_ < text_.size()) {
            const char c = text_[position_];
            if (is_blank(c)) {
                ++position_;
            } else if (c != '\\' || !skip_joint()) {
                return;
            }
        }
    }
    /// Steps over blanks, comments and line ends.
    void skip_to_token() {
        for (skip_blanks(); position_ < text_.size() && at_line_end(); skip_blanks()) skip_line();
    }
    /// True at the end of the text, of a line, or before a comment.
    bool at_line_end() const {
        return position_ >= text_.size() || is_newline(text_[position_]) ||
               text_[position_] == comment_;
    }
    bool at_end() const { return position_ >= text_.size(); }
    /// Steps behind the end of this line.
    void skip_line();
    /// Steps behind the end of this line and of those that a backslash outside a comment joins to
    /// it.
    void skip_joined_lines();

    /// The characters up to the next blank or line end; steps over them. May be empty.
    std::string_view read_token();
    /// Reads a decimal number; `what` names it in a message. Not finite numbers are returned as
    /// such.
    double read_number(const char* what);
    /// Reads a decimal whole number and stops behind its last digit.
    std::int64_t read_integer_prefix(const char* what);
    /// Reads a decimal whole number that a blank or the line's end follows.
    std::int64_t read_integer(const char* what);

    std::size_t position() const { return position_; }
    void set_position(std::size_t position) { position_ = position; }
    std::string_view rest() const { return text_.substr(position_); }

    /// Throws `InputError` "name:line: message", the line being the one that holds the position.
    [[noreturn]] void fail(InputFault fault, const std::string& message) const {
        fail_at(position_, fault, message);
    }
    [[noreturn]] void fail_at(std::size_t position, InputFault fault,
                              const std::string& message) const;

    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    static bool is_newline(char c) { return c == '\n' || c == '\r'; }

private:
    bool skip_joint();
    bool at_token_end() const {
        return position_ >= text_.size() || is_blank(text_[position_]) ||
               is_newline(text_[position_]) || text_[position_] == comment_ ||
               text_[position_] == '\\';
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t position_ = 0;
    char comment_;
};

}  // namespace kinequad
