// Names and numbers as they are read.

// What is known by names that a text gives, which may be those of what every object has: "constructor" is as any other.
export const byName = (pairs = []) => Object.assign(Object.create(null), Object.fromEntries(pairs));

// A number in six digits.
export const short = (x) => String(Number(x.toPrecision(6)));

// A number in three digits, as it is read.
export const figure = (x) => {
  const size = Math.abs(x);
  if (x === 0 || (size >= 1e-3 && size < 1e4)) return String(Number(x.toPrecision(3)));
  return x.toExponential(1).replace("e+", "e");
};

export const GREEK = byName(Object.entries({ alpha: "α", beta: "β", gamma: "γ", delta: "δ", theta: "θ", kappa: "κ", lambda: "λ", mu: "μ", nu: "ν",
  rho: "ρ", phi: "φ", chi: "χ", psi: "ψ", omega: "ω", Omega: "Ω", Gamma: "Γ", eta: "η", sigma: "σ", tau: "τ", xi: "ξ", epsilon: "ε" }));

// A name as it is read: Greek letters, primes, an index below.
export function readable(name) {
  // a costate of one removal has that behind it
  if (name.startsWith("P0_")) return `P<sub>${readable(name.slice(3).split("@")[0])}</sub>`;
  const [, stem, index, primes] = /^(.*?)_?(\d*)('*)$/.exec(name);
  const [head, ...rest] = stem.split("_");
  const [, word, digits] = /^(\D*)(\d*)$/.exec(head) ?? [null, head, ""];
  const numbers = digits && index ? `${digits},${index}` : digits + index;
  const below = [numbers, ...rest.map((part) => GREEK[part] ?? part)].filter((part) => part !== "").join(" ");
  return `${GREEK[word] ?? word}${below ? `<sub>${below}</sub>` : ""}${"′".repeat(primes.length)}`;
}
