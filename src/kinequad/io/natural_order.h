#pragma once

#include <string_view>

namespace kinequad {

/// True where `a` comes before `b` in the natural order of file names: runs of digits compare as
/// numbers ("frame2" before "frame10"), everything else by bytes; names that differ in leading
/// zeros only compare by bytes. A strict total order.
bool is_naturally_before(std::string_view a, std::string_view b);

}  // namespace kinequad
