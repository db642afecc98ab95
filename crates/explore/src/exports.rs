//! What the page calls: functions of numbers only, so that no glue between the languages has to be generated.
//!
//! A question is written to the place that [`question_at`] gives, [`ask`] answers it, and the answer is read
//! from the places that are asked for then.

use std::cell::RefCell;
use std::panic::PanicHookInfo;

use symbolic::Broken;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::{Answer, Explorer};

thread_local! {
    static QUESTION: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static EXPLORER: RefCell<Explorer> = RefCell::default();
    static ANSWER: RefCell<Answer> = RefCell::default();
}

/// Where a question of `length` bytes is to be written.
#[wasm_bindgen]
pub fn question_at(length: usize) -> usize {
    QUESTION.with_borrow_mut(|question| {
        question.clear();
        question.resize(length, 0);
        question.as_ptr() as usize
    })
}

/// Answers the question. Where it breaks off, the message is left as the text.
#[wasm_bindgen]
pub fn ask() {
    ANSWER.set(Answer::default());
    let said = |panic: &PanicHookInfo| Answer { text: Broken::of(panic).to_string(), numbers: Vec::new() };
    std::panic::set_hook(Box::new(move |panic| ANSWER.set(said(panic))));
    let question = QUESTION.with_borrow(|bytes| String::from_utf8_lossy(bytes).into_owned());
    ANSWER.set(EXPLORER.with_borrow_mut(|explorer| explorer.answer(&question)));
}

/// Where the text of the answer is.
#[wasm_bindgen]
pub fn text_at() -> usize {
    ANSWER.with_borrow(|answer| answer.text.as_ptr() as usize)
}

/// Its bytes.
#[wasm_bindgen]
pub fn text_length() -> usize {
    ANSWER.with_borrow(|answer| answer.text.len())
}

/// Where the numbers of the answer are.
#[wasm_bindgen]
pub fn numbers_at() -> usize {
    ANSWER.with_borrow(|answer| answer.numbers.as_ptr() as usize)
}

/// How many they are.
#[wasm_bindgen]
pub fn numbers_length() -> usize {
    ANSWER.with_borrow(|answer| answer.numbers.len())
}
