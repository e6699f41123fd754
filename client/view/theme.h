// How the panel looks. Needs a Dear ImGui context.
#pragma once

namespace caustream::view {

// `scale`: of the monitor, 1 at 96 dots per inch. Takes a readable font of the system where there is one.
void applyTheme(float scale);

}  // namespace caustream::view
