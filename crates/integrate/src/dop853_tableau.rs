//! Coefficients of Dormand and Prince's explicit Runge–Kutta method of order 8(5,3), dense output of order 7.
//!
//! Source: E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed.,
//! Springer 1993, section II.10, and the book's code DOP853; here rounded to double precision. The tests
//! below check *every* Butcher condition: the 200 of order ≤ 8 for the step, those of order ≤ 5 and ≤ 3 for
//! the embedded formulas and the 85 of order ≤ 7, as polynomials in θ, for the dense output.

/// One sparse row of the tableau: `Σ_m weight[m] · k[from[m]]`, stages counted from 0.
pub(crate) struct Row<const M: usize> {
    pub(crate) from: [usize; M],
    pub(crate) weight: [f64; M],
}

/// Stages of the step, the rates at its end (stage 12) and the three more of the dense output.
pub(crate) const STAGES: usize = 16;

/// Nodes `c_i`.
#[rustfmt::skip]
pub(crate) const NODES: [f64; STAGES] = [
    0.0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274,
    0.2816496580927726, 0.3333333333333333, 0.25, 0.3076923076923077,
    0.6512820512820513, 0.6, 0.8571428571428571, 1.0,
    1.0, 0.1, 0.2, 0.7777777777777778,
];

/// Stage 1.
pub(crate) const STAGE_1: Row<1> = Row { from: [0], weight: [0.05260015195876773] };

/// Stage 2.
pub(crate) const STAGE_2: Row<2> = Row { from: [0, 1], weight: [0.0197250569845379, 0.0591751709536137] };

/// Stage 3.
pub(crate) const STAGE_3: Row<2> = Row { from: [0, 2], weight: [0.02958758547680685, 0.08876275643042054] };

/// Stage 4.
pub(crate) const STAGE_4: Row<3> =
    Row { from: [0, 2, 3], weight: [0.2413651341592667, -0.8845494793282861, 0.924834003261792] };

/// Stage 5.
pub(crate) const STAGE_5: Row<3> =
    Row { from: [0, 3, 4], weight: [0.037037037037037035, 0.17082860872947386, 0.12546768756682242] };

/// Stage 6.
pub(crate) const STAGE_6: Row<4> =
    Row { from: [0, 3, 4, 5], weight: [0.037109375, 0.17025221101954405, 0.06021653898045596, -0.017578125] };

/// Stage 7.
pub(crate) const STAGE_7: Row<5> = Row {
    from: [0, 3, 4, 5, 6],
    weight: [
        0.03709200011850479,
        0.17038392571223998,
        0.10726203044637328,
        -0.015319437748624402,
        0.008273789163814023,
    ],
};

/// Stage 8.
pub(crate) const STAGE_8: Row<6> = Row {
    from: [0, 3, 4, 5, 6, 7],
    weight: [
        0.6241109587160757,
        -3.3608926294469414,
        -0.868219346841726,
        27.59209969944671,
        20.154067550477894,
        -43.48988418106996,
    ],
};

/// Stage 9.
pub(crate) const STAGE_9: Row<7> = Row {
    from: [0, 3, 4, 5, 6, 7, 8],
    weight: [
        0.47766253643826434,
        -2.4881146199716677,
        -0.590290826836843,
        21.230051448181193,
        15.279233632882423,
        -33.28821096898486,
        -0.020331201708508627,
    ],
};

/// Stage 10.
pub(crate) const STAGE_10: Row<8> = Row {
    from: [0, 3, 4, 5, 6, 7, 8, 9],
    weight: [
        -0.9371424300859873,
        5.186372428844064,
        1.0914373489967295,
        -8.149787010746927,
        -18.52006565999696,
        22.739487099350505,
        2.4936055526796523,
        -3.0467644718982196,
    ],
};

/// Stage 11.
pub(crate) const STAGE_11: Row<9> = Row {
    from: [0, 3, 4, 5, 6, 7, 8, 9, 10],
    weight: [
        2.273310147516538,
        -10.53449546673725,
        -2.0008720582248625,
        -17.9589318631188,
        27.94888452941996,
        -2.8589982771350235,
        -8.87285693353063,
        12.360567175794303,
        0.6433927460157636,
    ],
};

/// Weights `b_i` of the step (order 8).
pub(crate) const STEP: Row<8> = Row {
    from: [0, 5, 6, 7, 8, 9, 10, 11],
    weight: [
        0.054293734116568765,
        4.450312892752409,
        1.8915178993145003,
        -5.801203960010585,
        0.3111643669578199,
        -0.1521609496625161,
        0.20136540080403034,
        0.04471061572777259,
    ],
};

/// Stage 13 (dense output only).
pub(crate) const STAGE_13: Row<8> = Row {
    from: [0, 6, 7, 8, 9, 10, 11, 12],
    weight: [
        0.056167502283047954,
        0.25350021021662483,
        -0.2462390374708025,
        -0.12419142326381637,
        0.15329179827876568,
        0.00820105229563469,
        0.007567897660545699,
        -0.008298,
    ],
};

/// Stage 14 (dense output only).
pub(crate) const STAGE_14: Row<8> = Row {
    from: [0, 5, 6, 7, 10, 11, 12, 13],
    weight: [
        0.03183464816350214,
        0.028300909672366776,
        0.053541988307438566,
        -0.05492374857139099,
        -0.00010834732869724932,
        0.0003825710908356584,
        -0.00034046500868740456,
        0.1413124436746325,
    ],
};

/// Stage 15 (dense output only).
pub(crate) const STAGE_15: Row<8> = Row {
    from: [0, 5, 6, 7, 8, 12, 13, 14],
    weight: [
        -0.42889630158379194,
        -4.697621415361164,
        7.683421196062599,
        4.06898981839711,
        0.3567271874552811,
        -0.0013990241651590145,
        2.9475147891527724,
        -9.15095847217987,
    ],
};

/// Step minus embedded formula of order 5.
pub(crate) const ERROR_5: Row<8> = Row {
    from: [0, 5, 6, 7, 8, 9, 10, 11],
    weight: [
        0.01312004499419488,
        -1.2251564463762044,
        -0.4957589496572502,
        1.6643771824549864,
        -0.35032884874997366,
        0.3341791187130175,
        0.08192320648511571,
        -0.022355307863886294,
    ],
};

/// Embedded formula of order 3.
pub(crate) const EMBEDDED_3: Row<3> =
    Row { from: [0, 8, 11], weight: [0.2440944881889764, 0.7338466882816118, 0.022058823529411766] };

/// Coefficient 4 of the dense output, in units of the step.
pub(crate) const DENSE_4: Row<12> = Row {
    from: [0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
    weight: [
        -8.428938276109013,
        0.5667149535193777,
        -3.0689499459498917,
        2.38466765651207,
        2.117034582445028,
        -0.871391583777973,
        2.2404374302607883,
        0.6315787787694688,
        -0.08899033645133331,
        18.148505520854727,
        -9.194632392478356,
        -4.436036387594894,
    ],
};

/// Coefficient 5 of the dense output, in units of the step.
pub(crate) const DENSE_5: Row<12> = Row {
    from: [0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
    weight: [
        10.427508642579134,
        242.28349177525817,
        165.20045171727028,
        -374.5467547226902,
        -22.113666853125306,
        7.733432668472264,
        -30.674084731089398,
        -9.332130526430229,
        15.697238121770845,
        -31.139403219565178,
        -9.35292435884448,
        35.81684148639408,
    ],
};

/// Coefficient 6 of the dense output, in units of the step.
pub(crate) const DENSE_6: Row<12> = Row {
    from: [0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
    weight: [
        19.985053242002433,
        -387.0373087493518,
        -189.17813819516758,
        527.8081592054236,
        -11.57390253995963,
        6.8812326946963,
        -1.0006050966910838,
        0.7777137798053443,
        -2.778205752353508,
        -60.19669523126412,
        84.32040550667716,
        11.99229113618279,
    ],
};

/// Coefficient 7 of the dense output, in units of the step.
pub(crate) const DENSE_7: Row<12> = Row {
    from: [0, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
    weight: [
        -25.69393346270375,
        -154.18974869023643,
        -231.5293791760455,
        357.6391179106141,
        93.40532418362432,
        -37.45832313645163,
        104.0996495089623,
        29.8402934266605,
        -43.53345659001114,
        96.32455395918828,
        -39.17726167561544,
        -149.72683625798564,
    ],
};
