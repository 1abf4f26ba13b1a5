#include "kinequad/report/drawable_polygons.h"

#include <fmt/format.h>

#include <algorithm>

#include "kinequad/core/error.h"

namespace kinequad {

Quads drawable_polygons(const Polygons& faces) {
    Eigen::Index count = 0;
    for (int f = 0; f < faces.count(); ++f) {
        const auto corners = static_cast<Eigen::Index>(faces[f].size());
        if (corners < 3) {
            throw InputError(InputFault::mesh,
                             fmt::format("face {} has {} corners; remove it", f, corners));
        }
        count += corners <= 4 ? 1 : corners - 2;
    }
    Quads rows(count, 4);
    Eigen::Index row = 0;
    for (int f = 0; f < faces.count(); ++f) {
        const auto corners = faces[f];
        if (corners.size() == 4) {
            rows.row(row++) << corners[0], corners[1], corners[2], corners[3];
            continue;
        }
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
            rows.row(row++) << corners[0], corners[k], corners[k + 1], -1;
        }
    }
    return rows;
}

}  // namespace kinequad
