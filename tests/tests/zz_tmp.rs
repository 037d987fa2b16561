use clebsch::Clebsch;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use nalgebra::Vector3;
#[test] fn t(){
 let b=TwoBodies{mass:[1.0,2.0],gravitation:1.5};
 let x=[Vector3::zeros(),Vector3::new(2.0,0.0,0.0)];
 let a=[Vector3::zeros();2];
 println!("{} {}", b.legendre(0.1,&x,&a), b.legendre_next(0.1,&x,&a));
 let a=[Vector3::new(0.1,0.0,0.0),Vector3::new(0.2,0.0,0.0)];
 println!("{} {}", b.legendre(0.1,&x,&a), b.legendre_next(0.1,&x,&a));
}
