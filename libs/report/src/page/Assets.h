#pragma once
// The page's own files and Vega, put into the library when it is built.
#include <string_view>

namespace slamot::report::assets {

std::string_view style();        ///< assets/page.css
std::string_view vegaLicence();  ///< assets/vega_licence.txt
std::string_view vegaBundle();   ///< Debian's libjs-vega, see assets/BundleVega.cmake
std::string_view scripts();      ///< assets/*.js in the order they run

}  // namespace slamot::report::assets
