// Answers questions by the program, which comes as a compiled module. One question, one answer.

let program;

function start(module) {
  const imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    // imports that describe the exports to generators of glue code; none is needed, as only numbers pass
    (imports[from] ??= {})[name] = () => {
      throw new Error(`${name} is not for this page`);
    };
  }
  program = { module };
  for (const [name, value] of Object.entries(new WebAssembly.Instance(module, imports).exports)) {
    // names end in a hash
    program[name.replace(/_[0-9a-f]{16}$/, "")] = value;
  }
}

// Places are asked for before the memory is looked at: it may grow, and is another buffer then.
function text() {
  const [at, length] = [program.text_at() >>> 0, program.text_length()];
  return new TextDecoder().decode(new Uint8Array(program.memory.buffer, at, length));
}

function ask(question) {
  const bytes = new TextEncoder().encode(question);
  const at = program.question_at(bytes.length) >>> 0;
  new Uint8Array(program.memory.buffer, at, bytes.length).set(bytes);
  program.ask();
  const [numbersAt, count] = [program.numbers_at() >>> 0, program.numbers_length()];
  const numbers = new Float64Array(program.memory.buffer, numbersAt, count);
  return { answer: JSON.parse(text()), numbers: numbers.slice() };
}

onmessage = ({ data: { module, id, question } }) => {
  if (module) return start(module);
  const began = performance.now();
  let reply;
  try {
    reply = ask(question);
  } catch (error) {
    // what it says of that, if anything; it is started anew, as its memory is not to be trusted
    let said = "";
    try {
      said = text();
    } catch {}
    said ||= `${error.message}: this is a fault of deltaq; please report it`;
    reply = { answer: { refused: `the computation broke off: ${said}` }, numbers: new Float64Array() };
    start(program.module);
  }
  postMessage({ id, ...reply, milliseconds: performance.now() - began }, [reply.numbers.buffer]);
};
