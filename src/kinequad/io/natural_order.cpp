#include "kinequad/io/natural_order.h"

#include <algorithm>

namespace kinequad {
namespace {

bool is_digit(char c) { return '0' <= c && c <= '9'; }

/// Takes the run of digits that `text` begins with off it, without its leading zeros.
std::string_view take_digits(std::string_view& text) {
    const auto end = static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) -
                                              text.begin());
    std::string_view digits = text.substr(0, end);
    text.remove_prefix(end);
    digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
    return digits;
}

}  // namespace

bool is_naturally_before(std::string_view a, std::string_view b) {
    std::string_view rest_a = a;
    std::string_view rest_b = b;
    while (!rest_a.empty() && !rest_b.empty()) {
        if (is_digit(rest_a[0]) && is_digit(rest_b[0])) {
            const std::string_view number_a = take_digits(rest_a);
            const std::string_view number_b = take_digits(rest_b);
            if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
            if (number_a != number_b) return number_a < number_b;
        } else {
            // string_view compares its characters as unsigned bytes.
            if (rest_a[0] != rest_b[0]) return rest_a.substr(0, 1) < rest_b.substr(0, 1);
            rest_a.remove_prefix(1);
            rest_b.remove_prefix(1);
        }
    }
    if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
    return a < b;
}

}  // namespace kinequad
