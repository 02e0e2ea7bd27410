// The look of every page.
#pragma once

namespace palpate::page {

// CSS: system fonts, light and dark colours with contrasts of at least 4.5 (WCAG AA), narrow
// screens, and paper.
[[nodiscard]] const char* style();

}  // namespace palpate::page
