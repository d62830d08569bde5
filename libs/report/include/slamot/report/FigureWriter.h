#pragma once
// Figures on disk.
#include <filesystem>
#include <stdexcept>

#include "slamot/report/Figure.h"

namespace slamot::report {

/// A figure could not be drawn: one sentence, naming the Debian package to install where a program is
/// missing.
class ReportError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

struct FigureFormats {
    bool spec = true, svg = true, png = true;
    double png_zoom = 2;  ///< PNG pixels per figure pixel
};

/// Writes `stem`.vg.json, `stem`.svg and `stem`.png as asked; `stem` may hold any characters a file name may.
/// Missing parent folders are made. Throws ReportError; the specification has then been written in any case,
/// so that the figure can be drawn later, and no half-written picture is left.
void writeFigure(const Figure& figure, const std::filesystem::path& stem, const FigureFormats& formats = {});

}  // namespace slamot::report
