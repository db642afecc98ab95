//! Names of symbols as LaTeX.

/// `phi1'` as \dot{\varphi}_{1}: primes are dots, Greek names Greek letters, what follows the first
/// underscore and digits at the end are subscripts.
pub(crate) fn latex_name(name: &str) -> String {
    let stem = name.trim_end_matches('\'');
    let primes = name.len() - stem.len();
    let (base, subscript) = split(stem);
    let letter = word(base);
    let dotted = match primes {
        0 => letter,
        1 => format!(r"\dot{{{letter}}}"),
        2 => format!(r"\ddot{{{letter}}}"),
        3 => format!(r"\dddot{{{letter}}}"),
        n => format!(r"{{{letter}}}^{{({n})}}"),
    };
    let parts: Vec<String> = subscript.split('_').filter(|part| !part.is_empty()).map(word).collect();
    if parts.is_empty() { dotted } else { format!("{dotted}_{{{}}}", parts.join(", ")) }
}

/// Base and subscript.
fn split(stem: &str) -> (&str, &str) {
    if let Some((base, subscript)) = stem.split_once('_')
        && !base.is_empty()
    {
        return match split(base) {
            (_, "") => (base, subscript),
            // `phi1_x`: both are subscripts
            (letters, _) => (letters, &stem[letters.len()..]),
        };
    }
    let base = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    if base.is_empty() { (stem, "") } else { stem.split_at(base.len()) }
}

fn word(word: &str) -> String {
    if let Some(letter) = greek(word) {
        return letter;
    }
    if word.chars().count() == 1 && word != "_" || word.bytes().all(|c| c.is_ascii_digit()) {
        return word.to_owned();
    }
    // A word and its number, as in a subscript `x1`
    let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
    if letters.len() < word.len() && (letters.len() == 1 || greek(letters).is_some()) {
        let letter = greek(letters).unwrap_or_else(|| letters.to_owned());
        return format!("{letter}_{{{}}}", &word[letters.len()..]);
    }
    format!(r"\mathrm{{{}}}", word.replace('_', r"\_"))
}

fn greek(word: &str) -> Option<String> {
    const LETTERS: [&str; 34] = [
        "alpha", "beta", "gamma", "delta", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu", "nu", "xi", "pi",
        "rho", "sigma", "tau", "upsilon", "chi", "psi", "omega", "Gamma", "Delta", "Theta", "Lambda", "Xi", "Pi",
        "Sigma", "Upsilon", "Phi", "Psi", "Omega", "vartheta", "varphi",
    ];
    match word {
        "phi" => Some(r"\varphi".to_owned()),
        "epsilon" | "eps" => Some(r"\varepsilon".to_owned()),
        _ => LETTERS.contains(&word).then(|| format!(r"\{word}")),
    }
}
