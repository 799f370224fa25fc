//! A small valid file of every format.

use std::f64::consts::PI;

use lobe_formats::{Format, Sides, mbsdf, merl, mueller_csv, pbsdf, polarised as polarised_file, rgl};
use lobe_table::rgl::{Images, Parts};
use lobe_table::{Channels, Scatter, half_diff, mueller, polarised, spherical};

/// A DDR file in R G B, relative intensities and refraction.
pub const DDR: &str = ";; small\nSource Measured\nTypeSym PlaneSymmetrical\nTypeColorModel RGB\nTypeData Intensity Relative\nsigma 2\n 0 60\n\
    sigmat\n 0 40\npsi 2 0 90\nphi 2\n 0 180\ntheta 2\n 0 90\nred\n kbdf 1 1 1 1\n def\n 1 2 3 4 1 2 3 4\n 1 2 3 4 1 2 3 4\n enddef\n\
    gre kbdf 1 1 1 1 def 1 2 3 4 1 2 3 4 1 2 3 4 1 2 3 4 enddef\nblu kbdf 1 1 1 1 def 1 2 3 4 1 2 3 4 1 2 3 4 1 2 3 4 enddef\n";
/// An SDR file at two wavelengths.
pub const SDR: &str = "Source Measured\nTypeColorModel spectral 2\nsigma 3\n 0 45 90\nwl 400\ndef\n 0.1 0.2 1\nenddef\nwl 700 def 0 0 1 enddef\n";
/// A Zemax file of one channel.
pub const ZEMAX: &str = "# small\nSource Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n\
    AngleOfIncidence 2\n10 50\nScatterAzimuth 2\n0 180\nScatterRadial 2\n0 90\n\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n3 4\nTIS 0.2\n5 6\n7 8\nDataEnd\n";
/// An SSDD file: a BTDF and a mirror reflectance.
pub const SSDD: &str = "# Software: x\nVERSION 0.3\nDATA_TYPE btdf\nCOLOR_MODEL rgb\nPARAM_TYPE specular_coordinate_system\n\
    REDUCTION_TYPE bilateral_symmetry\nPARAM0_LIST 0 60\nPARAM2_LIST 0 90\nPARAM3_LIST 0 90 180\nPARAM4_LIST 0 -5\n\
    NAME thin film\nDATA ascii\n# PARAM3: 0\n0 0 1\n1 0 1\n2 0 1\n3 0 1\n4 0 1\n5 0 1\n6 0 1\n7 0 1\n8 0 1\n9 0 1\n10 0 1\n11 0 1\n\
    DATA_TYPE specular_reflectance\nCOLOR_MODEL monochrome\nPARAM0_LIST 0 90\nDATA ascii\n0.04\n1\n";
/// A LightTools file in X Y Z.
pub const LIGHT_TOOLS: &str = "# made by hand\nSymmetry PlaneSymmetrical\nSpectralContent XYZ\nScatterAzimuth 3 90 180 270\n\
    ScatterRadial 2 0 60\nDataBegin\nAOI 30 POI 0 Side Front Wavelength 550 ScatterType BRDF TristimulusValue TrisX TIS 0.5\n\
    1 2 1 3 1 4\nTristimulusValue TrisY TIS 0.5 5 6 5 7 5 8\nTristimulusValue TrisZ TIS 0.5 0 0 0 0 0 0\n\
    AOI 0 TristimulusValue TrisX TIS 1 9 9 9 9 9 9\nTristimulusValue TrisY TIS 1 9 9 9 9 9 9\n\
    TristimulusValue TrisZ TIS 1 9 9 9 9 9 9\nDataEnd\n";
/// An ASTM E1392 file of two channels.
pub const ASTM: &str = "BRDF_TYPE measured\nNUM_POINTS 3\nVARS theta_i,phi_i,theta_s,phi_s,400nm,500nm\n\
    0.1,0,0.2,3.0,1,2\n0.1,0,0.2,-3.0,1,2\n0.1,0,0.4,1.0,3,4\n";
/// A Cornell file of two wavelengths, one record over two lines.
pub const CORNELL: &str = "# num wls\r\n2\r\n# wls\r\n400 500\r\n0.1 0 0.2 3 1 2\n0.1 0 0.2 -3 1 2\n0.1 0 0.3 1\n 3 4\n0.4 0 0.2 3 5 6\n\
        0.4 0 0.2 2 7 8\n0.4 0 0.2 0 7 8\n";
/// A FRED file.
pub const FRED: &str = "type bsdf_data\nformat angles=deg bsdf=value scale=1\n10\t0\n0\t0\t0.5\n10 0 2\n20 90 0.1\n30\t0\n30 0 3\n\
        20 10 1\n20 350 1\n";
/// An RPC Photonics file with its first lines.
pub const RPC: &str = "!!EDS 5-15\n!!BSDF Data\n5.000\t15.000\n0 0 18\n0 90 18\n5 15 20\n10 0 3\n7 0\n0 0 18\n1 0 17\n";
/// A file of a gonio-photometer of pab, with both sides, as f times the cosine.
pub const PAB: &str = "#pgII\n#sample_name \"made here\"\n#incident_angle 30 0\n#upphi 90\n#datapoints_in_file: 6\n\
        #format: theta phi DSF\n0 0 0.3\n30 180 0.8\n60 90 0.1\n180 0 0.05\n150 180 0.2\n120 90 0.01\n";
/// A surface property of TracePro with a table.
pub const TRACE_PRO: &str = "TracePro Surface Property Data\nName\tmade\nScatter 5\n\n\
        Temperature\tWavelength\tIncAngle\tAziAngle\tAbso_S\tAbso_P\tRefl_S\tRefl_P\n300 0.55 0 0 0.1 0.1 0.2 0.4\n\
        300 0.55 30 0 0.1 0.1 0.3 0.5\nTable_BSDF_Data\n\
        Temperature Wavelength IncAngle AziAngle ScatterBeta ScatterAzimuth BRDF BTDF\n300 0.55 0 0 0 0 0.3 0\n\
        300 0.55 0 0 0.5 0 0.2 0\n300 0.55 0 0 1 0 0.1 0\n300 0.55 30 0 0 0 0.3 0\n300 0.55 30 0 0.4 0 0.2 0\n\
        300 0.55 30 0 0.4 180 0.2 0\nSAVE-DATA\n";
/// A simple scattering surface of Speos.
pub const SPEOS_SIMPLE: &str =
    "OPTIS - Simple scattering surface file v2.0\r\nmade here\r\nReflection\r\n30 60 0 15\r\n";
/// A coating of Speos.
pub const SPEOS_COATED: &str = "OPTIS - Coated surface file v1.0\nExample\n2 2\n\t480\t\t580\t\t\n0\t32\t68\t2\t98\t\n\
        \t28\t72\t6\t94\t\n90\t100\t0\t100\t0\t\n\t100\t0\t100\t0\t\n";
/// A lumos-sat file.
pub const LUMOS: &str = "# Name\n#\n# phi_in theta_in phi_out theta_out brdf\n45 180 -20 0 0.1\n45 180 45 0 9\n45 180 60 0 1\n\
        60 180 60 0 9\n60 180 70 0 2\n";
/// An ALTA file.
pub const ALTA: &str = "#DIM 3 1\n#VS 0\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n0.2 0.2 0 0.5\n\
        0.2 0.2 0.1 0.4\n0.2 -1.57079632679 0 0.1\n0.5 0.5 0 0.8\n0.5 0.1 -0.3 0.1\n";
/// An OpenMATERIAL 3D file.
pub const OPEN_MATERIAL: &str = "{\"metadata\": {}, \"brdf\": {\"wavelengths\": [4.1e-07, 5e-7], \"lookupTable\": [[4.1e-07, 0.1, 0.2, 0, 1],\n\
        [4.1e-07, 0.1, 0.3, 0.5, 2], [4.1e-07, 0.1, 0.3, null, 2], [5e-07, 0.1, 0.2, 0, 3], [5e-07, 0.1, 0.3, 0.5, 4]]}}";
/// A NIST file of polarised PTFE at two wavelengths.
pub const NIST: &str = "lambda,thetai,phi,thetar,phir,f_r11,a,b,c,d,e,f,g,h,i,j,k,l,m,n,o\r\n\
        0.532,-30,0,30,0,0.4,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\r\n0.532,-30,0,10,90,0.3,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\r\n\
        0.633,-30,0,30,0,0.5,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\r\n0.633,-30,0,10,90,0.3,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\r\n";

/// Coefficients of an expansion in Zernike polynomials, with the wavelength and without.
pub const ZERNIKE: &str = "1, 1, 0, 0, 0, 0, 0, 2.1\n1, 1, 1, 1, 1, 1, 0, -0.3\n1, 1, 2, 0, 0, 0, 1, 0.2\n\
        1, 1, 4, 2, 2, 2, 0, 0.05\n2, 2, 1, 1, -1, 1, 0, 0.3\n";

/// A grid in either kind of coordinates, with its rows in arbitrary order.
pub fn csv(head: &str, unit: f64) -> String {
    let mut rows = Vec::new();
    for (i, (sigma, theta)) in [(10.0, 0.0), (40.0, 0.0), (40.0, 30.0), (10.0, 30.0)].into_iter().enumerate() {
        for (j, phi) in [0.0, 90.0, 180.0, 270.0].into_iter().enumerate() {
            rows.push(format!("{},{},{},{}", phi * unit, sigma * unit, theta * unit, i * 4 + j));
        }
    }
    rows.rotate_left(5);
    format!("# mine\n{head}\n{}\n", rows.join("\n"))
}

/// A file with a basis of three patches, or with a tree, and one block.
pub fn sheet(structure: &str, data: &str) -> String {
    let basis = "<AngleBasis><AngleBasisName>mine</AngleBasisName>\
        <AngleBasisBlock><ThetaBounds><LowerTheta>0</LowerTheta><UpperTheta>30</UpperTheta></ThetaBounds>\
        <nPhis>1</nPhis></AngleBasisBlock>\
        <AngleBasisBlock><ThetaBounds><LowerTheta>30</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds>\
        <nPhis>2</nPhis></AngleBasisBlock></AngleBasis>";
    format!(
        "<?xml version=\"1.0\"?>\n<WindowElement><Optical><Layer>\n<Material><Name>a &amp; b</Name></Material>\n\
        <DataDefinition><IncidentDataStructure>{structure}</IncidentDataStructure>{basis}</DataDefinition>\n\
        <WavelengthData><Wavelength unit=\"Integral\">Visible</Wavelength><WavelengthDataBlock>\n\
        <WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n\
        <ColumnAngleBasis>mine</ColumnAngleBasis><RowAngleBasis>mine</RowAngleBasis>\n\
        <ScatteringData>{data}</ScatteringData>\n\
        </WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>\n"
    )
}

/// A table with named columns in JSON.
pub const JSON: &str = "{\"theta_i_deg\": [10, 10, 10], \"theta_o\": [0, 20, 20], \"phi_o\": [0, 0, 90],\n\
    \"R\": [1, 2, 3], \"G\": [4, 5, 6], \"B\": [7, 8, 9]}";
/// A table as written by a German spreadsheet, with an angle of incidence on a separate line.
pub const OWN: &str = "Sample;blue\r\nAngle of incidence: 30 deg\r\n\r\ntheta_o;phi_o [deg];BRDF [1/sr];std\r\n0;0;0,5;0,1\r\n\
    20;0;0,25;-\r\n20;90;0,25;0\r\n40;180;;0\r\nAOI: 50\r\n0;0;0,5;0\r\n20;10;0,75;0\r\nend\r\n";
/// A table with a wavelength per row, names in a comment, and blanks between columns.
pub const LONG: &str =
    "# theta_i  theta_o  lambda [nm]  f\n10  -20  450  1\n10  -20  550  2\n10   30  450  3\n10   30  550  nan\n";
/// A table with a column per angle of incidence.
pub const WIDE: &str = "theta_o \\ theta_i\t10\t20\n-10\t1\t2\n0\t3\t4\n10\t5\t6\n";
/// A tensor tree of rank 3.
pub const TREE: &str = "{{1}{2}{3}{4}{5}{6}{7}{8 8 8 8 8 8 8 8}}";
/// The values of a matrix of three patches.
pub const NINE: &str = "1, 2, 3,\n4 5 6\n7 8, 9,";

/// An intensity of cos over the hemisphere, and a transmission of f = const: both Lambertian.
pub fn speos_file(kind: &str, step: usize) -> String {
    let table = |is_transmission: bool, is_intensity: bool| {
        let mut text = format!("{} 5\n0 90 180 270 360\n", 90 / step + 1);
        for theta in (0..=90).step_by(step) {
            let angle = if is_transmission { 90 + theta } else { theta };
            let cosine = f64::from(angle).to_radians().cos().abs();
            let value = if is_intensity { cosine } else { 7.0 };
            text += &format!("{angle} {value} {value} {value} {value} {value}\n");
        }
        text
    };
    match kind {
        "anisotropic" => format!(
            "OPTIS - Anisotropic BSDF surface file v8.0\n0\nComment\n14\ntwo\nlines here\n0 1 0\n1 1\n0\n2\n0 90\n1\n30\n1\n30\n\
            1\n0\n2\n0 30\n10 0\nReflection\n2\n400 50\n700 25\n0 0\n\n1\n550 10\n{}{}{}{}End of file\n",
            table(false, true),
            table(false, true),
            table(true, true),
            table(true, true)
        ),
        _ => format!(
            "OPTIS - brdf surface file v8.0\n0\nComment\n0\n\n1 1\n1\n1 2\n30\n400 700\n50\n{}25\n{}10\n{}20\n{}",
            table(false, false),
            table(false, false),
            table(true, false),
            table(true, false)
        ),
    }
}

/// A small RGL file.
pub fn tiny_rgl() -> Vec<u8> {
    let images = |shape: [usize; 3]| {
        let texels = (0..shape.iter().product()).map(|i| 0.5 + (i % 7) as f32).collect();
        Images::new("tiny", shape, texels).expect("valid images")
    };
    let material = lobe_table::rgl::Data::new(Parts {
        description: "tiny".into(),
        phi_i: vec![0.0],
        theta_i: vec![0.0, 1.5],
        ndf: images([1, 2, 3]),
        sigma: images([1, 2, 2]),
        vndf: images([2, 3, 2]),
        luminance: images([2, 2, 2]),
        channels: Channels::Spectral(vec![500.0, 600.0]),
        spectra: images([4, 2, 2]),
        jacobian: true,
        valid: Some(vec![255]),
    });
    rgl::to_bytes(&material.expect("a valid material")).expect("bytes")
}

/// Mueller matrices in specular coordinates.
pub fn tiny_polarised() -> Vec<u8> {
    let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 1.5], vec![0.0, 3.0]];
    let data = polarised::Data::new(knots, vec![550.0], vec![0.25; 128]).expect("valid matrices");
    polarised_file::to_bytes(&data).expect("bytes")
}

/// The same as a table.
pub fn tiny_mueller_csv() -> Vec<u8> {
    let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 1.5], vec![0.0, 3.0]];
    let data = polarised::Data::new(knots, vec![550.0], vec![0.25; 128]).expect("valid matrices");
    mueller_csv::to_text(&data).into_bytes()
}

/// A small KAIST file.
pub fn tiny_pbsdf() -> Vec<u8> {
    let knots = [vec![-3.0, 3.0], vec![0.0, 1.5], vec![0.5], vec![500.0, 600.0]];
    pbsdf::to_bytes(&mueller::Data::new(knots, vec![0.25; 128]).expect("a valid material")).expect("bytes")
}

/// A file in the MERL format, with few bins.
pub fn tiny_merl() -> Vec<u8> {
    merl::to_bytes(&half_diff::Data::new([2, 1, 3], vec![0.5; 18]).expect("a valid material")).expect("bytes")
}

/// A small Fourier BSDF: three channels, two series of several coefficients, and metadata.
pub fn tiny_fourier() -> Vec<u8> {
    let mu = [-1.0_f32, -0.5, 0.0, 0.0, 0.5, 1.0];
    let (knots, metadata) = (mu.len(), b"{ \"made\": \"here\" }");
    let coefficients: Vec<f32> = (0..15).map(|at| 0.5 / (1 + at % 3) as f32).collect();
    let mut bytes = b"SCATFUN\x01".to_vec();
    for number in [1, knots as i32, coefficients.len() as i32, 3, 3, 1, metadata.len() as i32, 0, 0] {
        bytes.extend(number.to_le_bytes());
    }
    let floats = |bytes: &mut Vec<u8>, floats: &[f32]| floats.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    floats(&mut bytes, &[1.5, 0.0, 0.0, 0.0, 0.0]);
    floats(&mut bytes, &mu);
    floats(&mut bytes, &vec![0.0; knots * knots]);
    for at in 0..knots * knots {
        // Light that travels down and is reflected, and some that is transmitted.
        let series = match (mu[at / knots] > 0.0, mu[at % knots] < 0.0) {
            (true, true) => [0_i32, 3],
            (false, true) => [9, 2],
            _ => [0, 0],
        };
        series.iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    }
    floats(&mut bytes, &coefficients);
    bytes.extend(metadata);
    bytes
}

/// A small MDL file with two sides.
pub fn tiny_mbsdf() -> Vec<u8> {
    let side = |scatter, phis: &[f64]| {
        let thetas = vec![0.0, PI / 4.0];
        let (knots, values) = ([thetas.clone(), vec![0.0], thetas, phis.to_vec()], vec![0.5; 4 * phis.len()]);
        let grid = spherical::Data::new(scatter, knots, Channels::Mono, values).and_then(spherical::Data::mirrored);
        Some(grid.expect("a valid material"))
    };
    let reflection = side(Scatter::Reflection, &[0.0, PI / 2.0, PI]);
    mbsdf::to_bytes(&Sides { reflection, transmission: side(Scatter::Transmission, &[0.0]) }).expect("bytes")
}

/// At least one file of every format except UTIA, whose files are all two megabytes long.
pub fn all() -> Vec<(Format, Vec<u8>)> {
    let texts = [
        (Format::Ddr, DDR.into()),
        (Format::Sdr, SDR.into()),
        (Format::Zemax, ZEMAX.into()),
        (Format::Ssdd, SSDD.into()),
        (Format::LightTools, LIGHT_TOOLS.into()),
        (Format::Astm, ASTM.into()),
        (Format::Cornell, CORNELL.into()),
        (Format::Fred, FRED.into()),
        (Format::Rpc, RPC.into()),
        (Format::Pab, PAB.into()),
        (Format::SpeosSurface, SPEOS_SIMPLE.into()),
        (Format::SpeosSurface, SPEOS_COATED.into()),
        (Format::TracePro, TRACE_PRO.into()),
        (Format::Lumos, LUMOS.into()),
        (Format::Alta, ALTA.into()),
        (Format::OpenMaterial, OPEN_MATERIAL.into()),
        (Format::Nist, NIST.into()),
        (Format::Zernike, ZERNIKE.into()),
        (Format::Speos, speos_file("anisotropic", 30)),
        (Format::Speos, speos_file("brdf", 30)),
        (Format::WindowXml, sheet("Columns", NINE)),
        (Format::WindowXml, sheet("TensorTree3", TREE)),
        (Format::Goniometer, csv("phi_o,theta_i,theta_o,f", 1.0)),
        (Format::Goniometer, csv("phi_deg,sigma,theta,Y", 1.0)),
        (Format::Goniometer, JSON.into()),
        (Format::Goniometer, OWN.into()),
        (Format::Goniometer, LONG.into()),
        (Format::Goniometer, WIDE.into()),
    ];
    let binaries = [
        (Format::Rgl, tiny_rgl()),
        (Format::Pbsdf, tiny_pbsdf()),
        (Format::Polarised, tiny_polarised()),
        (Format::MuellerCsv, tiny_mueller_csv()),
        (Format::Merl, tiny_merl()),
        (Format::Mbsdf, tiny_mbsdf()),
        (Format::Fourier, tiny_fourier()),
    ];
    texts.into_iter().map(|(format, text): (_, String)| (format, text.into_bytes())).chain(binaries).collect()
}
