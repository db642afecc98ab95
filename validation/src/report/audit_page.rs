//! The pages about the paper's equations.

use std::fmt::Write;

use anyhow::Result;
use serde_json::{Map, Value, json};
use symbolic::Vanishing;

use crate::audit::{
    Constants, Example, Finding, Form, HORIZONS, Paper, STATEMENT, Stationarity, Variant, Verdict, cone, refusal,
};
use crate::report::numbers::{enumerate, short};
use crate::report::{File, Table};

/// Below this `dI/dε` counts as zero: differences of the perturbed action are good to about 1e-9.
const STATIONARY: f64 = 1e-8;

/// LaTeX longer than this stands in blocks of its own.
const SHORT: usize = 130;

/// What the audit found.
pub struct AuditReport {
    findings: Vec<Finding>,
    stationarity: Stationarity,
    constants: Constants,
    cone: Example,
    written: Vec<Variant>,
    refusal: String,
}

impl AuditReport {
    /// Checks every equation.
    ///
    /// # Errors
    /// Where the paper's formulas cannot be read or a motion cannot be had.
    pub fn new() -> Result<AuditReport> {
        let paper = Paper::new()?;
        let findings = paper.numbers().into_iter().map(|number| paper.check(number)).collect::<Result<_>>()?;
        Ok(AuditReport {
            findings,
            stationarity: Stationarity::new(&paper)?,
            constants: Constants::new()?,
            cone: cone()?,
            written: paper.written()?,
            refusal: refusal()?,
        })
    }

    /// Numbers of the equations with a verdict.
    fn with(&self, verdict: Verdict) -> Vec<String> {
        self.findings.iter().filter(|f| f.verdict == verdict).map(|f| f.number.clone()).collect()
    }

    /// The first line of the page.
    pub fn headline(&self) -> String {
        let [holds, misprint, incomplete, open] =
            [Verdict::Holds, Verdict::Misprint, Verdict::Incomplete, Verdict::Open].map(|v| self.with(v).len());
        let left = if open == 0 { String::new() } else { format!(", {open} are open") };
        format!(
            "Of {} equations of the paper {holds} hold as printed, {misprint} after a misprint is corrected, {incomplete} are incomplete{left}.",
            holds + misprint + incomplete + open
        )
    }

    /// The verdicts for machines.
    pub fn verdicts(&self) -> Value {
        let equations: Map<String, Value> =
            self.findings.iter().map(|f| (f.number.clone(), f.verdict.word().into())).collect();
        let answer = |v: &Variant| Value::from(if v.form.holds() { "holds" } else { "does not hold" });
        let readings: Map<String, Value> = self
            .findings
            .iter()
            .flat_map(|f| f.variants.iter().map(move |v| (format!("{}: {}", f.number, v.words), answer(v))))
            .collect();
        let stationary: Map<String, Value> =
            self.stationarity.readings.iter().map(|r| (r.name.into(), (r.largest() < STATIONARY).into())).collect();
        json!({ "equations": equations, "readings": readings, "stationary": stationary })
    }

    /// The pages.
    pub fn files(&self) -> Vec<File> {
        vec![
            File { path: "paper-audit.md".into(), text: self.page() },
            File { path: "paper-examples.md".into(), text: self.examples() },
        ]
    }

    fn page(&self) -> String {
        let mut page = format!("# The paper's equations, each checked\n\n**{}**\n\n", self.headline());
        page += "The equations of Gao 2017 ([doi:10.3969/j.issn.1673-9833.2017.05.001](https://doi.org/10.3969/j.issn.1673-9833.2017.05.001)), in their order. \
                 A *residual* is left side minus right side once every name is replaced by what it stands for: velocities of points of contact and energies that come from positions and \
                 rotations, motions that roll, variations of an action. It is zero by simplification (0), or at 32 random points up to round-off (0 at 32 points), or it is not zero, \
                 and then its value at a random point of coordinates, velocities and parameters of order 1 stands here. Verdicts are computed from residuals; \
                 what is printed below is what was evaluated.\n\n\
                 - **holds**: zero as printed.\n- **misprint**: not zero as printed, zero as corrected.\n- **incomplete**: true in a special case or of a name that is not explained; zero as completed.\n\n\
                 Sections: [all verdicts](#all-verdicts), [what the constants of integration are](#what-the-constants-of-integration-are), \
                 [is the action stationary?](#is-the-action-stationary), [equation by equation](#equation-by-equation). Examples 2 and 3, whose motions the paper leaves to the reader, \
                 are written out in [paper-examples.md](paper-examples.md).\n\n";
        let columns = ["equation", "about", "verdict", ">residual, printed", ">residual, corrected", "checked"];
        let mut table = Table::new(columns);
        for f in &self.findings {
            let word = if f.verdict == Verdict::Holds { "holds".into() } else { format!("**{}**", f.verdict.word()) };
            let [printed, corrected] = [&f.printed, &f.corrected].map(form_residual);
            table.row(&[&f.number, &f.title, &word, &printed, &corrected, &checked(f)]);
        }
        let _ = write!(page, "## All verdicts\n\n{table}");
        page += &self.constants_section();
        page += &self.stationarity_section();
        page += "\n## Equation by equation\n";
        for f in &self.findings {
            page += &equation(f);
        }
        page
    }

    fn constants_section(&self) -> String {
        let c = &self.constants;
        let mut text = String::from("\n## What the constants of integration are\n\n");
        text += "The paper says of $t_1$ in example 1 and of $C_i$, $D_e$, $E_{ile}$ in (35) that the initial conditions determine them. They do not: they are the initial values \
                 $P_i(t_0)$ of costates, in the statement $G = L + P\\cdot B$, $\\dot P = -G_w$, and no coordinate or velocity at $t_0$ says anything about them. Numbers, all computed for this page:\n\n";
        let _ = writeln!(
            text,
            "- **One start, two motions.** Sledge, the same $(q_0, v_0)$ (they differ by {}), $C = {}$ and $C = {}$: within {} s the motions get {} apart.",
            short(c.two[2]),
            short(c.two[0]),
            short(c.two[1]),
            short(c.duration),
            short(c.two[3])
        );
        let _ = writeln!(
            text,
            "- **What the variational principle asks for** is $P(t_1) = 0$, $C_i = \\int_{{t_0}}^{{t_1}} \\partial G/\\partial w_i\\,dt$. For the sledge that is $C = g\\,t_1\\sin\\alpha$, and $t_1$ is the end of the time over which the action is taken: \
             the boundary-value problem gives {}. The motion depends on when it is to end: with $t_1 = {}$ s and $t_1 = {}$ s it is already {} apart within the sledge scene's {} s.",
            enumerate(
                &c.natural
                    .iter()
                    .map(|[t, x]| format!("$C = {}$ for $t_1 = {}$ s", short(*x), short(*t)))
                    .collect::<Vec<_>>()
            ),
            short(HORIZONS[0]),
            short(HORIZONS[1]),
            short(c.natural_gap),
            short(c.duration)
        );
        let _ = writeln!(
            text,
            "- **They are multipliers.** The removed-constraint motion is the vakonomic motion of the augmented system, whose coordinates are $(q, u)$ and whose constraints are $\\dot w = B$, with multipliers \
             $\\mu_0 = -P(t_0) - \\partial L/\\partial\\dot w$. Largest difference of any coordinate within 1 s: {}.",
            enumerate(
                &c.augmented
                    .iter()
                    .map(|a| {
                        let constants: Vec<String> = a.constants.iter().map(|x| short(*x)).collect();
                        format!("{} for `{}`, $C = ({})$", short(a.gap), a.scene, constants.join(", "))
                    })
                    .collect::<Vec<_>>()
            )
        );
        let _ = writeln!(
            text,
            "- **For one choice the sledge's motion is vakonomic.** With $t_1 = -\\dot u_0/(g\\sin\\alpha\\cos\\varphi_0) = {}$ s it is the vakonomic motion with $\\mu_0 = g\\,t_1\\sin\\alpha\\sin\\varphi_0 = {}$: gap {} over {} s. For other $t_1$, with the best $\\mu_0$ that was found:\n",
            short(c.matching),
            short(c.multiplier),
            short(c.gap),
            short(c.duration)
        );
        let mut table = Table::new([">$t_1$, s", ">$C$", ">best $\\mu_0$", ">gap that is left"]);
        for h in &c.horizons {
            table.cells([h.horizon, h.constant, h.multiplier, h.gap].map(short));
        }
        // within the item of the list
        text.extend(table.to_string().lines().map(|line| format!("  {line}\n")));
        let _ = writeln!(
            text,
            "\n- **Without any constraint they matter too.** `planar-body`, on which nothing is constrained, its velocities written along turning axes: with $P(t_0) = 0$ it is {} from Newton's motion and its rotation, on which no torque acts, is {} rad off at the end; \
             with $P(t_0) = -(\\dot x_0, \\dot y_0)$ the gap is {}. The principle gives Newton's motion for one choice of its constants and not for others, and does not say which.",
            short(c.body_zero[0]),
            short(c.body_zero[1]),
            short(c.body_right)
        );
        text
    }

    fn stationarity_section(&self) -> String {
        let s = &self.stationarity;
        let mut text = String::from("\n## Is the action stationary?\n\n");
        text += "A system with $\\ddot u$ in $\\beta$: $\\dot y = \\tfrac12\\dot x^2$, $L = \\tfrac12(\\dot x^2 + \\dot y^2 - x^2 - y^2)$, removed by $x = u + \\tfrac12\\dot u$, $\\lambda = y$, $\\beta = \\tfrac12\\dot x^2$. Each reading of (34) is solved for the highest derivative and integrated over $[0, 1]$ with the natural constant, \
                 $P(1) = 0$. Then the action itself, nested integral included, is perturbed along it, $u + \\varepsilon\\,\\delta u$, for four $\\delta u$ of size 1 that vanish at both ends with their first derivatives. No derivation is used in that.\n\n";
        let mut table =
            Table::new(["motion of", ">order in $u$", "$dI/d\\varepsilon$, four $\\delta u$", "stationary"]);
        for r in &s.readings {
            let numbers: Vec<String> = r.derivatives.iter().map(|d| two_digits(*d)).collect();
            let word = if r.largest() < STATIONARY { "yes" } else { "**no**" };
            table.row(&[&r.name, &r.order, &numbers.join(", "), &word]);
        }
        let _ = writeln!(
            text,
            "{table}\n({STATEMENT}: $\\frac{{d^2}}{{dt^2}}G_{{\\ddot u}} - \\frac{{d}}{{dt}}G_{{\\dot u}} + G_u = 0$, $\\dot P = -G_w$. The motion that `removed-constraint` derives from the same start and constants differs by {}.)\n",
            short(s.gap)
        );
        text += "The same for the $\\delta I$ of example 1, along a curve that is no motion; $u$ and $\\varphi$ are varied together:\n\n";
        let columns = [">$dI/d\\varepsilon$ measured", ">from $\\delta I$ as printed", ">as corrected"];
        let mut table = Table::new(columns);
        for numbers in &s.sledge {
            table.cells(numbers.map(|x| format!("{x:.8}")));
        }
        text + &table.to_string()
    }

    fn examples(&self) -> String {
        let mut page = String::from(
            "# Examples 2 and 3 of the paper, written out\n\nThe paper leaves their motions to the reader. These are the removed-constraint equations, with the misprints of [paper-audit.md](paper-audit.md) corrected.\n\n## Example 2: ball in a cone\n\nScene [ball-in-cone](scenes/ball-in-cone.md); displacement parameters $\\varphi, \\chi, \\theta$; memory $r$ with costate $P_r$, and $\\gamma$, which $L$ does not contain. Momenta and slopes, $\\dot r$ and $\\dot\\gamma$ by (10) and (12):\n\n",
        );
        let c = &self.cone;
        for (name, meaning) in &c.quantities {
            let _ = writeln!(page, "```math\n{name} = {meaning}\n```");
        }
        page += "\nEquations of motion:\n\n";
        for line in &c.equations {
            let _ = writeln!(page, "```math\n{line}\n```");
        }
        let _ = writeln!(
            page,
            "\nEach balance and the equation of $P_r$, minus what `removed-constraint` derives and what is integrated: {}. Free constant: $P_r(t_0)$.",
            residuals(&c.residuals)
        );
        let _ = write!(
            page,
            "\n## Example 3: three cylinders\n\nScene [three-cylinders](scenes/three-cylinders.md). The paper's $u$ is not fit for equations of motion: $\\ddot u$ comes in as $\\frac{{d}}{{dt}}(\\dot u/\\dot\\theta)$ only, and the equations cannot be solved for the highest derivatives ({}). With $W = \\dot u/\\dot\\theta$, a function of the configuration by (25), they can, and (24) with (28) becomes short: one integral $\\kappa$ is all that is left of three, and it is $C$ plus half the integral in (27). (The scene's removal keeps the paper's three.)\n",
            self.refusal
        );
        for group in &self.written {
            let _ = writeln!(page, "\n{} (left minus right: {}):\n", group.words, form_residual(&group.form));
            if !group.words.starts_with("The paper's three") {
                for line in &group.form.lines {
                    let _ = writeln!(page, "```math\n{}\n```", line.latex);
                }
            }
        }
        page += "\n$V$ is the velocity of the centre along the axis of the upper cylinder, $U$ across it, $\\Omega/R$ its rate of roll, $M$ the momentum of $\\theta$. $W$ and $\\theta$ are the displacement parameters, $\\kappa$ is memory with costate $P$. Free constant: $P(t_0)$; with the paper's three integrals there are three, of which this is one: what $P_{\\varphi_1}$ and $P_{\\varphi_2}$ have beyond the values above is constant and adds $c_1\\dot\\varphi_1 + c_2\\dot\\varphi_2$ to $G$.\n";
        page
    }
}

/// One equation with its formulas, remarks and other readings.
fn equation(f: &Finding) -> String {
    let mut text = format!("\n### {}: {}\n\n", f.number, f.title);
    let _ = writeln!(text, "**{}.** {}{}\n", capital(f.verdict.word()), f.note, scan(f));
    let long = |form: &Form| form.lines.iter().any(|l| l.latex.len() > SHORT);
    if f.corrected.lines.is_empty() {
        text += &blocks("", &f.printed);
    } else if long(&f.printed) || long(&f.corrected) {
        text += &blocks("As printed:", &f.printed);
        text += &blocks(corrected_words(f), &f.corrected);
    } else {
        let mut table = Table::new(["as printed", &corrected_words(f).trim_end_matches(':').to_lowercase()]);
        let forms = [&f.printed, &f.corrected];
        let [printed, corrected] = forms.map(|form| form.lines.iter().map(|l| &l.latex));
        for (one, two) in printed.zip(corrected).chain(f.printed.integrals.iter().zip(&f.corrected.integrals)) {
            table.cells([one, two].map(|latex| format!("${latex}$")));
        }
        table.cells(forms.map(|form| format!("residual {}", form_residual(form))));
        text += &table.to_string();
    }
    if let Some([printed, corrected]) = &f.along {
        let list = |numbers: &[f64]| numbers.iter().map(|x| two_digits(*x)).collect::<Vec<_>>().join(", ");
        let _ = writeln!(
            text,
            "\nAlong the computed motion of the scene, largest residuals: {} as printed, {} as corrected (second derivatives are differences of velocities).",
            list(printed),
            list(corrected)
        );
    }
    if !f.variants.is_empty() {
        let mut table = Table::new(["also tried", "holds", ">residual"]);
        for v in &f.variants {
            let word = if v.form.holds() { "yes" } else { "no" };
            table.row(&[&v.words, &word, &form_residual(&v.form)]);
        }
        let _ = write!(text, "\n{table}");
    }
    text
}

fn blocks(words: &str, form: &Form) -> String {
    let mut text = String::new();
    if form.lines.is_empty() {
        return text;
    }
    if !words.is_empty() {
        let _ = writeln!(text, "{words}\n");
    }
    for line in form.lines.iter().map(|l| &l.latex).chain(&form.integrals) {
        let _ = writeln!(text, "```math\n{line}\n```");
    }
    let _ = writeln!(text, "\nResidual {}.\n", form_residual(form));
    text
}

fn corrected_words(f: &Finding) -> &'static str {
    if f.verdict == Verdict::Incomplete { "As completed:" } else { "As corrected:" }
}

fn scan(f: &Finding) -> String {
    if f.scan.is_empty() { String::new() } else { format!(" *{}*", f.scan) }
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// How an equation was checked.
fn checked(f: &Finding) -> &'static str {
    let all = || f.printed.lines.iter().chain(&f.corrected.lines);
    match (f.verdict, f.along.is_some()) {
        (Verdict::Definition, _) => "–",
        (_, true) => "simplified; along a motion",
        _ if all().any(|l| matches!(l.residual, Vanishing::Numerically { .. })) => "at random points",
        _ => "simplified",
    }
}

/// The residual that is farthest from zero, of all lines.
fn form_residual(form: &Form) -> String {
    if form.lines.is_empty() {
        return "–".into();
    }
    residuals(&form.lines.iter().map(|l| l.residual).collect::<Vec<_>>())
}

fn residuals(all: &[Vanishing]) -> String {
    let values = all.iter().filter_map(|r| if let Vanishing::No { value, .. } = r { Some(value.abs()) } else { None });
    if let Some(largest) = values.reduce(f64::max) {
        return two_digits(largest);
    }
    if all.iter().all(|r| matches!(r, Vanishing::Exactly)) {
        return "0".into();
    }
    let points = all.iter().find_map(|r| if let Vanishing::Numerically { points } = r { Some(*points) } else { None });
    points.map_or("undecided".into(), |points| format!("0 at {points} points"))
}

fn two_digits(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if (0.01..100.0).contains(&x.abs()) {
        let digits = (1 - x.abs().log10().floor() as i32).max(0) as usize;
        return format!("{x:.digits$}");
    }
    format!("{x:.1e}")
}
