# cmake -DFOLDER=... -DPARTS=a,b,... -DOUT=... -P BundleVega.cmake
# Debian ships Vega as one file per module and no file of them all: each becomes an entry of `vegaModules`, a
# CommonJS module that assets/vega.js loads. Comments that point at source maps are left out: a page has none.
string(REPLACE "," ";" parts "${PARTS}")
file(WRITE ${OUT}.part "const vegaModules = {};\n")
foreach(part ${parts})
  # Debian's file names differ from the module's name in one case.
  string(REPLACE "vega-selections" "vega-selection" file_name ${part})
  file(READ ${FOLDER}/${file_name}.min.js text)
  string(REGEX REPLACE "\n?//# sourceMappingURL=[^\n]*" "" text "${text}")
  file(APPEND ${OUT}.part "vegaModules['${part}'] = function (exports, module, require) {\n")
  file(APPEND ${OUT}.part "${text}")
  file(APPEND ${OUT}.part "\n};\n")
endforeach()
file(RENAME ${OUT}.part ${OUT})
