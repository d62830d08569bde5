// Loads the modules of the Vega bundle, which are written for CommonJS.
'use strict';
const requireVega = (() => {
  const loaded = {};
  return function require(name) {
    if (!loaded[name]) {
      const module = {exports: loaded[name] = {}};
      vegaModules[name](module.exports, module, require);
      loaded[name] = module.exports;
    }
    return loaded[name];
  };
})();

/** What the figures need of Vega. */
const vega = (() => {
  const {transforms} = requireVega('vega-dataflow');
  for (const part of ['vega-transforms', 'vega-view-transforms', 'vega-encode']) {
    Object.assign(transforms, requireVega(part));
  }
  return {parse: requireVega('vega-parser').parse, View: requireVega('vega-view').View};
})();
