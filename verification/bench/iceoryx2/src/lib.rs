// SPDX-License-Identifier: Apache-2.0
//! Write and read through a process-local publish-subscribe service of iceoryx2, for the port cases of `./mamori bench`.
//! As for every other subject, the value goes from the writer's memory to the reader's memory.

use core::ffi::c_void;
use iceoryx2::port::{publisher::Publisher, subscriber::Subscriber};
use iceoryx2::prelude::*;
use std::hint::black_box;

struct Exchange<const WORDS: usize> {
    publisher: Publisher<local::Service, [u64; WORDS], ()>,
    subscriber: Subscriber<local::Service, [u64; WORDS], ()>,
    values: Box<[[u64; WORDS]; 2]>, // written in turn; first words 0 and 1
    read: Box<[u64; WORDS]>,
}

impl<const WORDS: usize> Exchange<WORDS> {
    fn open() -> Result<Self, Box<dyn core::error::Error>> {
        let node = NodeBuilder::new().create::<local::Service>()?;
        let name = format!("mamori/bench/{WORDS}");
        let service = node
            .service_builder(&name.as_str().try_into()?)
            .publish_subscribe::<[u64; WORDS]>()
            .open_or_create()?;
        let mut values = Box::new([[0; WORDS]; 2]);
        values[1][0] = 1;
        Ok(Self {
            publisher: service.publisher_builder().create()?,
            subscriber: service.subscriber_builder().create()?,
            values,
            read: Box::new([0; WORDS]),
        })
    }

    /// The sum of the first words that were read; a value that did not arrive is missing from it.
    fn run(&mut self, count: u64) -> u64 {
        let mut sum = 0;
        for number in 0..count {
            let value = black_box(&self.values[(number & 1) as usize]);
            if let Ok(sample) = self.publisher.loan_uninit() {
                let _ = sample.write_payload(*value).send();
            }
            if let Ok(Some(sample)) = self.subscriber.receive() {
                *self.read = *sample.payload();
                black_box(&mut self.read);
                sum += self.read[0];
            }
        }
        sum
    }
}

fn open<const WORDS: usize>() -> *mut c_void {
    set_log_level(LogLevel::Fatal);
    match Exchange::<WORDS>::open() {
        Ok(exchange) => Box::into_raw(Box::new(exchange)).cast(),
        Err(_) => core::ptr::null_mut(),
    }
}

/// # Safety
/// `handle` comes from `open` with the same `WORDS` and is used by one thread at a time.
unsafe fn run<const WORDS: usize>(handle: *mut c_void, count: u64) -> u64 {
    (*handle.cast::<Exchange<WORDS>>()).run(count)
}

macro_rules! export {
    ($words:literal, $open:ident, $run:ident) => {
        #[no_mangle]
        pub extern "C" fn $open() -> *mut c_void {
            open::<$words>()
        }
        /// # Safety
        /// `handle` comes from the function above and is used by one thread at a time.
        #[no_mangle]
        pub unsafe extern "C" fn $run(handle: *mut c_void, count: u64) -> u64 {
            run::<$words>(handle, count)
        }
    };
}

export!(1, mamori_bench_iceoryx2_open_8, mamori_bench_iceoryx2_run_8);
export!(8, mamori_bench_iceoryx2_open_64, mamori_bench_iceoryx2_run_64);
export!(128, mamori_bench_iceoryx2_open_1024, mamori_bench_iceoryx2_run_1024);
export!(8192, mamori_bench_iceoryx2_open_65536, mamori_bench_iceoryx2_run_65536);
