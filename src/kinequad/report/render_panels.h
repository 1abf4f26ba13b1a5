#pragma once

#include <string>
#include <vector>

#include "kinequad/report/render_mesh.h"

namespace kinequad {

/// One picture of several side by side.
struct RenderPanel {
    RenderScene scene;
    Camera camera;
    std::string caption;  ///< one line, drawn below; empty for none
};

/// Draws `panels` in rows of `columns` into one picture of the size that `options` asks for.
/// Throws what `render_mesh` throws, and `InputError` (usage) where there is no panel, `columns` is
/// below one, or a panel would have no pixels.
Image render_panels(const std::vector<RenderPanel>& panels, int columns,
                    const RenderOptions& options, const Context& context);

}  // namespace kinequad
