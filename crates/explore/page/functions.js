// What a formula can call, as the editor lists it, and what each is.

export const FUNCTIONS = [
  ["sin(x)"], ["cos(x)"], ["tan(x)"], ["sec(x)"], ["csc(x)"], ["cot(x)"], ["asin(x)"], ["acos(x)"], ["atan(x)"], ["atan2(y, x)", "angle of the direction (x, y)"],
  ["sinh(x)"], ["cosh(x)"], ["tanh(x)", "a smooth sign"], ["asinh(x)"], ["acosh(x)"], ["atanh(x)"], ["exp(x)"], ["log(x)", "natural"], ["ln(x)"], ["sqrt(x)"], ["pow(x, y)"],
  ["step(t, a, b, width)", "0 before a and after b, 1 between them"], ["dot(a, b)"], ["cross(a, b)"], ["norm(a)", "length of a vector"], ["transpose(A)"], ["diag(a, b, c)", "diagonal matrix"],
  ["rotation(zxz, a, b, c)", "matrix of turns about these axes of the body, one after the other"], ["angular_velocity(R)", "in axes of space"], ["body_angular_velocity(R)", "in axes of the body"],
];
