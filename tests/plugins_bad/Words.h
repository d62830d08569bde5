#pragma once
// Texts made from the definitions that tests/plugins_bad/CMakeLists.txt gives.
#define SLAMOT_TEXT_OF(X) #X
#define SLAMOT_TEXT(X) SLAMOT_TEXT_OF(X)
