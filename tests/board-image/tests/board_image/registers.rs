//! The registers after the start, beside the sections of the manuals that say what they mean.

use sprag_board_image::model::Model;
use sprag_board_image::rig::{Rig, image_for};
use sprag_shared::settings::Settings;

/// Name, address, value, section.
type Row = (&'static str, u32, u32, &'static str);

/// Of RM0090 rev. 21 where nothing else is said.
const F405: &[Row] = &[
    ("RCC_CR", 0x4002_3800, 0x030B_0083, "7.3.1"),
    ("RCC_PLLCFGR", 0x4002_3804, 0x2740_2A04, "7.3.2"),
    ("RCC_CFGR", 0x4002_3808, 0x0000_940A, "7.3.3"),
    ("RCC_AHB1ENR", 0x4002_3830, 0x0070_1007, "7.3.10"),
    ("RCC_APB1ENR", 0x4002_3840, 0x1000_400E, "7.3.13"),
    ("RCC_APB2ENR", 0x4002_3844, 0x0000_1112, "7.3.14"),
    ("FLASH_ACR", 0x4002_3C00, 0x0000_0705, "3.9.1"),
    ("FLASH_CR", 0x4002_3C10, 0x8000_0200, "3.9.7"),
    ("FLASH_OPTCR", 0x4002_3C14, 0x0FFF_AAE1, "3.9.9"),
    ("GPIOA_MODER", 0x4002_0000, 0xA828_A900, "8.4.1"),
    ("GPIOA_PUPDR", 0x4002_000C, 0x6410_1000, "8.4.4"),
    ("GPIOA_AFRL", 0x4002_0020, 0x5350_0000, "8.4.9"),
    ("GPIOA_AFRH", 0x4002_0024, 0x0000_0770, "8.4.10"),
    ("GPIOB_MODER", 0x4002_0400, 0xA900_A280, "8.4.1"),
    ("GPIOB_PUPDR", 0x4002_040C, 0x2000_5200, "8.4.4"),
    ("GPIOB_AFRL", 0x4002_0420, 0x2205_0000, "8.4.9"),
    ("GPIOB_AFRH", 0x4002_0424, 0x5550_0000, "8.4.10"),
    ("GPIOC_MODER", 0x4002_0800, 0x0105_A03F, "8.4.1"),
    ("GPIOC_PUPDR", 0x4002_080C, 0x0400_0000, "8.4.4"),
    ("GPIOC_AFRL", 0x4002_0820, 0x3300_0000, "8.4.9"),
    ("TIM8_CR1", 0x4001_0400, 0x0000_0081, "17.4.1"),
    ("TIM8_CCMR1", 0x4001_0418, 0x0000_6868, "17.4.7"),
    ("TIM8_CCER", 0x4001_0420, 0x0000_0011, "17.4.9"),
    ("TIM8_PSC", 0x4001_0428, 0x0000_0000, "17.4.11"),
    ("TIM8_ARR", 0x4001_042C, 0x0000_20CF, "17.4.12"),
    ("TIM8_BDTR", 0x4001_0444, 0x0000_9C00, "17.4.18"),
    ("TIM4_CR1", 0x4000_0800, 0x0000_0001, "18.4.1"),
    ("TIM4_SMCR", 0x4000_0808, 0x0000_0003, "18.4.3"),
    ("TIM4_CCMR1", 0x4000_0818, 0x0000_3131, "18.4.7"),
    ("TIM4_ARR", 0x4000_082C, 0x0000_FFFF, "18.4.12"),
    ("TIM5_CR1", 0x4000_0C00, 0x0000_0001, "18.4.1"),
    ("TIM5_CCMR2", 0x4000_0C1C, 0x0000_0D00, "18.4.8"),
    ("TIM5_CCER", 0x4000_0C20, 0x0000_1000, "18.4.9"),
    ("TIM5_ARR", 0x4000_0C2C, 0xFFFF_FFFF, "18.4.12"),
    ("TIM5_OR", 0x4000_0C50, 0x0000_0040, "18.4.21"),
    ("RCC_CSR", 0x4002_3874, 0x0000_0003, "7.3.21"),
    ("ADC1_CR1", 0x4001_2004, 0x0000_0500, "13.13.2"),
    ("ADC1_CR2", 0x4001_2008, 0x4000_0003, "13.13.3"),
    ("ADC1_SMPR1", 0x4001_200C, 0x0000_01FF, "13.13.4"),
    ("ADC1_SQR3", 0x4001_2034, 0x0000_000C, "13.13.11"),
    ("ADC1_JSQR", 0x4001_2038, 0x0015_A800, "13.13.12"),
    ("ADC_CCR", 0x4001_2304, 0x0001_0000, "13.13.16"),
    ("SPI1_CR1", 0x4001_3000, 0x0000_0B57, "28.5.1"),
    ("SPI2_CR1", 0x4000_3800, 0x0000_0B57, "28.5.1"),
    ("USART1_BRR", 0x4001_1008, 0x0000_005B, "30.6.3"),
    ("USART1_CR1", 0x4001_100C, 0x0000_200C, "30.6.4"),
    ("USART1_CR3", 0x4001_1014, 0x0000_00C0, "30.6.6"),
    ("DMA2_S2CR", 0x4002_6440, 0x0800_0501, "10.5.5"),
    ("DMA2_S2PAR", 0x4002_6448, 0x4001_1004, "10.5.7"),
    ("IWDG_PR", 0x4000_3004, 0x0000_0005, "21.4.2"),
    ("IWDG_RLR", 0x4000_3008, 0x0000_0004, "21.4.3"),
    ("PWR_CR", 0x4000_7000, 0x0000_C0F0, "5.4.1"),
    ("EXTI_IMR", 0x4001_3C00, 0x0001_0000, "12.3.1"),
    ("EXTI_RTSR", 0x4001_3C08, 0x0001_0000, "12.3.3"),
    ("DBGMCU_CR", 0xE004_2004, 0x0000_0000, "38.16.3"),
    ("DBGMCU_APB1_FZ", 0xE004_2008, 0x0000_1000, "38.16.4"),
    ("DWT_CTRL", 0xE000_1000, 0x4000_0000, "ARMv7-M C1.8.7"),
    ("SYST_CSR", 0xE000_E010, 0x0000_0007, "PM0214 4.5.1"),
    ("SYST_RVR", 0xE000_E014, 0x0001_481F, "PM0214 4.5.2"),
    ("NVIC_ISER0", 0xE000_E100, 0x0000_0002, "PM0214 4.3.2"),
    ("NVIC_IPR0", 0xE000_E400, 0x0000_0000, "PM0214 4.3.7"),
    ("SHPR3", 0xE000_ED20, 0xD000_0000, "PM0214 4.4.8"),
];

/// Chapters of RM0440 where nothing else is said: each register has a section of its name there.
const G474: &[Row] = &[
    ("RCC_CR", 0x4002_1000, 0x030B_0500, "RCC"),
    ("RCC_CFGR", 0x4002_1008, 0x0000_000F, "RCC"),
    ("RCC_PLLCFGR", 0x4002_100C, 0x0100_5413, "RCC"),
    ("RCC_AHB1ENR", 0x4002_1048, 0x0000_1105, "RCC"),
    ("RCC_AHB2ENR", 0x4002_104C, 0x0004_2007, "RCC"),
    ("RCC_APB1ENR1", 0x4002_1058, 0x1000_440E, "RCC"),
    ("RCC_APB2ENR", 0x4002_1060, 0x0000_7001, "RCC"),
    ("FLASH_ACR", 0x4002_2000, 0x0004_0704, "FLASH"),
    ("FLASH_CR", 0x4002_2014, 0xC000_0000, "FLASH"),
    ("FLASH_OPTR", 0x4002_2020, 0xFFEF_FCAA, "FLASH"),
    ("PWR_CR1", 0x4000_7000, 0x0000_0200, "PWR"),
    ("PWR_CR2", 0x4000_7004, 0x0000_000D, "PWR"),
    ("PWR_CR3", 0x4000_7008, 0x0000_C000, "PWR"),
    ("PWR_CR5", 0x4000_7080, 0x0000_0000, "PWR"),
    ("EXTI_IMR1", 0x4001_0400, 0x1F85_0000, "EXTI"),
    ("EXTI_RTSR1", 0x4001_0408, 0x0001_0000, "EXTI"),
    ("GPIOA_MODER", 0x4800_0000, 0xABEB_B9FF, "GPIO"),
    ("GPIOA_PUPDR", 0x4800_000C, 0x6410_0000, "GPIO"),
    ("GPIOA_AFRL", 0x4800_0020, 0x5050_0000, "GPIO"),
    ("GPIOA_AFRH", 0x4800_0024, 0x0000_0770, "GPIO"),
    ("GPIOB_MODER", 0x4800_0400, 0xA9FF_AEBF, "GPIO"),
    ("GPIOB_PUPDR", 0x4800_040C, 0x2000_5200, "GPIO"),
    ("GPIOB_AFRL", 0x4800_0420, 0x2205_0000, "GPIO"),
    ("GPIOB_AFRH", 0x4800_0424, 0x5550_0000, "GPIO"),
    ("GPIOC_MODER", 0x4800_0800, 0xF1F5_AFFF, "GPIO"),
    ("GPIOC_PUPDR", 0x4800_080C, 0x0400_0000, "GPIO"),
    ("GPIOC_AFRL", 0x4800_0820, 0x4400_0000, "GPIO"),
    ("DMAMUX_C0CR", 0x4002_0800, 0x0000_0041, "DMAMUX"),
    ("DMAMUX_C1CR", 0x4002_0804, 0x0000_0018, "DMAMUX"),
    ("DMAMUX_C2CR", 0x4002_0808, 0x0000_0019, "DMAMUX"),
    ("DMA1_CCR1", 0x4002_0008, 0x0000_0521, "DMA"),
    ("DMA1_CPAR1", 0x4002_0010, 0x4000_0824, "DMA"),
    ("DMA1_CCR2", 0x4002_001C, 0x0000_00A1, "DMA"),
    ("DMA1_CPAR2", 0x4002_0024, 0x4001_3824, "DMA"),
    ("DMA1_CPAR3", 0x4002_0038, 0x4001_3828, "DMA"),
    ("ADC1_CR", 0x5000_0008, 0x1000_0005, "ADC"),
    ("ADC1_CFGR", 0x5000_000C, 0x8200_3000, "ADC"),
    ("ADC1_SMPR1", 0x5000_0014, 0x07E0_01C0, "ADC"),
    ("ADC1_SQR1", 0x5000_0030, 0x0000_0200, "ADC"),
    ("ADC1_JSQR", 0x5000_004C, 0x0003_8401, "ADC"),
    ("ADC12_CCR", 0x5000_0308, 0x0003_0000, "ADC"),
    ("DAC3_CR", 0x5000_1000, 0x0000_0001, "DAC"),
    ("DAC3_DHR12R1", 0x5000_1008, 0x0000_0F07, "DAC"),
    ("DAC3_MCR", 0x5000_103C, 0x0000_8003, "DAC"),
    ("COMP_C1CSR", 0x4001_0200, 0x0003_0041, "COMP"),
    ("COMP_C3CSR", 0x4001_0208, 0x0003_0141, "COMP"),
    ("TIM8_CR1", 0x4001_3400, 0x0000_0081, "TIM1/TIM8/TIM20"),
    ("TIM8_CCMR1", 0x4001_3418, 0x0000_6868, "TIM1/TIM8/TIM20"),
    ("TIM8_CCER", 0x4001_3420, 0x0000_0011, "TIM1/TIM8/TIM20"),
    ("TIM8_PSC", 0x4001_3428, 0x0000_0000, "TIM1/TIM8/TIM20"),
    ("TIM8_ARR", 0x4001_342C, 0x0000_20CF, "TIM1/TIM8/TIM20"),
    ("TIM8_BDTR", 0x4001_3444, 0x0008_BC00, "TIM1/TIM8/TIM20"),
    ("TIM8_AF1", 0x4001_3460, 0x0000_000A, "TIM1/TIM8/TIM20"),
    ("TIM3_CR1", 0x4000_0400, 0x0000_0001, "TIM2 to TIM5"),
    ("TIM3_DIER", 0x4000_040C, 0x0000_0100, "TIM2 to TIM5"),
    ("TIM3_ARR", 0x4000_042C, 0x0000_20CF, "TIM2 to TIM5"),
    ("TIM4_CR1", 0x4000_0800, 0x0000_0001, "TIM2 to TIM5"),
    ("TIM4_SMCR", 0x4000_0808, 0x0000_0003, "TIM2 to TIM5"),
    ("TIM4_CCMR1", 0x4000_0818, 0x0000_5151, "TIM2 to TIM5"),
    ("TIM4_CCER", 0x4000_0820, 0x0000_0011, "TIM2 to TIM5"),
    ("TIM4_ARR", 0x4000_082C, 0x0000_FFFF, "TIM2 to TIM5"),
    ("TIM5_CR1", 0x4000_0C00, 0x0000_0001, "TIM2 to TIM5"),
    ("TIM5_CCMR1", 0x4000_0C18, 0x0000_000D, "TIM2 to TIM5"),
    ("TIM5_CCER", 0x4000_0C20, 0x0000_0001, "TIM2 to TIM5"),
    ("TIM5_ARR", 0x4000_0C2C, 0xFFFF_FFFF, "TIM2 to TIM5"),
    ("TIM5_TISEL", 0x4000_0C5C, 0x0000_0001, "TIM2 to TIM5"),
    ("RCC_CSR", 0x4002_1094, 0x0000_0003, "RCC"),
    ("SPI1_CR1", 0x4001_3000, 0x0000_035F, "SPI"),
    ("SPI1_CR2", 0x4001_3004, 0x0000_0F00, "SPI"),
    ("SPI2_CR1", 0x4000_3800, 0x0000_0367, "SPI"),
    ("SPI2_CR2", 0x4000_3804, 0x0000_0F00, "SPI"),
    ("USART1_CR1", 0x4001_3800, 0x0000_000D, "USART"),
    ("USART1_CR3", 0x4001_3808, 0x0000_10C0, "USART"),
    ("USART1_BRR", 0x4001_380C, 0x0000_00B6, "USART"),
    ("IWDG_PR", 0x4000_3004, 0x0000_0000, "IWDG"),
    ("IWDG_RLR", 0x4000_3008, 0x0000_009F, "IWDG"),
    ("TAMP_BKP0R", 0x4000_2500, 0x5A17_0474, "TAMP"),
    ("DBGMCU_CR", 0xE004_2004, 0x0000_0000, "DBG"),
    ("DBGMCU_APB1L_FZ", 0xE004_2008, 0x0000_1000, "DBG"),
    ("SYST_CSR", 0xE000_E010, 0x0000_0007, "PM0214 4.5.1"),
    ("SYST_RVR", 0xE000_E014, 0x0001_481F, "PM0214 4.5.2"),
    ("NVIC_ISER0", 0xE000_E100, 0x0000_0002, "PM0214 4.3.2"),
    ("NVIC_IPR0", 0xE000_E400, 0x0000_0000, "PM0214 4.3.7"),
    ("SHPR3", 0xE000_ED20, 0xD000_0000, "PM0214 4.4.8"),
];

fn registers_are(model: Model, table: &[Row]) {
    let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
    rig.boot();
    let mut wrong = Vec::new();
    for &(name, address, value, section) in table {
        let found = rig.bench.chip_mut().load(address);
        println!("{name:14} {address:#010x} {found:#010x} {section}");
        if found != value {
            wrong.push(format!("{name} is {found:#010x}, not {value:#010x} ({section})"));
        }
    }
    assert!(wrong.is_empty(), "{model:?}: {}", wrong.join("\n"));
}

#[test]
fn the_registers_are_those_of_the_table() {
    registers_are(Model::F405, F405);
    registers_are(Model::G474, G474);
}
