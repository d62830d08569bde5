// Light and dark: the reader's choice, or what the system prefers; paper is always light.

const theme = (() => {
  const root = document.documentElement;
  const system = window.matchMedia('(prefers-color-scheme: dark)');
  const darkOf = new Map(Object.entries(JSON.parse(document.getElementById('dark-colours').textContent)));
  const namesColour = /^(fill|stroke|color|background)$|Color$/;
  const listeners = [];
  let choice = 'auto';
  let printing = false;

  function apply() {
    const dark = !printing && (choice === 'dark' || (choice === 'auto' && system.matches));
    const name = dark ? 'dark' : 'light';
    if (root.dataset.theme !== name) {
      root.dataset.theme = name;
      listeners.forEach((listener) => listener());
    }
  }

  const colourOf = (light) => (root.dataset.theme === 'dark' && darkOf.get(light)) || light;

  /** A copy of a specification with the colours of the theme in place of those for paper. Texts that look like a
      colour stay what they are: only what stands under a colour's name is one. */
  function themed(value, isColour = false) {
    if (root.dataset.theme !== 'dark') return value;
    if (typeof value === 'string') return isColour ? colourOf(value) : value;
    if (Array.isArray(value)) return value.map((part) => themed(part, isColour));
    if (value === null || typeof value !== 'object') return value;
    return Object.fromEntries(Object.entries(value).map(
        ([key, part]) => [key, key === 'data' ? part : themed(part, isColour || namesColour.test(key))]));
  }

  system.addEventListener('change', apply);
  apply();
  return {
    themed: (specification) => themed(specification),
    colourOf,
    colour: (name) => getComputedStyle(root).getPropertyValue(`--${name}`).trim(),
    onChange: (listener) => listeners.push(listener),
    choose: (name) => { choice = name; apply(); },
    isForPaper: () => printing,
    forPaper: (on) => { printing = on; apply(); },
  };
})();
